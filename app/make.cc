#include "models/make.h"

#include <memory>

#include "app/console.h"
#include "sim/io/file.h"
#include "sim/io/output_folder.h"

namespace continuum {

void AddMake(CLI::App& app) {
  struct Request {
    std::string robot, variant, out;
    MakeLayout layout;
  };
  CLI::App* const make =
      app.add_subcommand("make", "Write the MJCF of a robot from its description");
  const auto request = std::make_shared<Request>();
  make->add_option("robot", request->robot,
                   "The robot: models/<robot>/<name>.yaml, or an arm of your own as "
                   "models/trunk/trunk.yaml")
      ->required();
  make->add_option("--variant", request->variant,
                   "Another model of it. tdcr: disks, loads; spa: free, series; stiff_flop: braid");
  make->add_option("--series", request->layout.series, "spa: actuators on end");
  make->add_option("--rows", request->layout.rows, "spa: arms side by side");
  make->add_option("--links", request->layout.links, "spa: links of each actuator, even (10)");
  make->add_flag("--standing", request->layout.standing, "spa: it stands (else it hangs)");
  make->add_option("--out", request->out, "The MJCF file")->required();
  make->footer(
      "Example:\n  continuum make models/trunk/trunk.yaml --out trunk.xml"
      "\n  continuum make models/spa/spa.yaml --series 3 --standing --out three.xml");
  make->callback([request] {
    RequireWritable(request->out, {request->robot});
    WriteFile(request->out, MakeMjcf(request->robot, request->variant, request->layout));
  });
}

}  // namespace continuum
