#include "sim/experiment/registration_reader.h"

#include <functional>
#include <string>

#include "error.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

Registration::Vector ReadVector(const Yaml& y) {
  const auto numbers = y.Numbers();
  if (numbers.size() != 3) {
    throw Error::Input(y.Where(), "three numbers", std::to_string(numbers.size()));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

// Whether a part is to be estimated; anything else is read as what is known of it.
Registration::Part ReadPart(const Yaml& y, const std::function<void()>& known) {
  using Part = Registration::Part;
  if (y.IsScalar() && y.Text() == "estimate") return Part::kEstimate;
  known();
  return Part::kKnown;
}

}  // namespace

Registration ReadRegistration(const Yaml& y) {
  y.Only({"frame", "marker", "clock_shift"});
  Registration r;
  if (const auto frame = y.Find("frame")) {
    r.frame = ReadPart(*frame, [&] {
      if (!frame->IsMap()) {
        throw Error::Input(frame->Where(), "estimate | {rotation: [x, y, z], translation: [..]}",
                           frame->Found());
      }
      frame->Only({"rotation", "translation"});
      if (const auto v = frame->Find("rotation")) r.rotation = ReadVector(*v);
      if (const auto v = frame->Find("translation")) r.translation = ReadVector(*v);
    });
  }
  if (const auto marker = y.Find("marker")) {
    r.marker = ReadPart(*marker, [&] {
      if (!marker->IsMap()) {
        r.offset[""] = ReadVector(*marker);
        return;
      }
      for (const auto& sensor : marker->Keys()) r.offset[sensor] = ReadVector(marker->At(sensor));
    });
  }
  if (const auto clock = y.Find("clock_shift"))
    r.clock = ReadPart(*clock, [&] { r.clock_shift = clock->Number(); });
  return r;
}

}  // namespace continuum
