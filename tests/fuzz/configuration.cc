// The configuration of an effect: the law on the first line, then KEY=VALUE. What binds must step.
#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "engine.h"
#include "fuzz/fuzz.h"
#include "support/every_law.h"

namespace continuum {
namespace {

// "<config key="joint" value="q1"/>..." as the lines that are fed in.
std::string AsLines(const std::string& config) {
  std::string lines, word;
  std::istringstream in(config);
  for (int k = 0; std::getline(in, word, '"'); ++k) {
    if (k % 4 == 1) lines += "\n" + word;
    if (k % 4 == 3) lines += "=" + word;
  }
  return lines;
}

// A model with one law, compiled once: only the text of the configuration is exchanged.
class Bench {
 public:
  explicit Bench(const std::string& law) {
    const std::string xml = testing::Arm(testing::EffectOf(law), testing::Laws().at(law),
                                         "integrator=\"implicitfast\"");
    mjSpec* const spec = mj_parseXMLString(xml.c_str(), nullptr, nullptr, 0);
    if (!spec || !(good_ = mj_compile(spec, nullptr))) std::abort();
    mj_deleteSpec(spec);
    model_ = mj_copyModel(nullptr, good_);
    data_ = mj_makeData(good_);
    plugin_ = mjp_getPluginAtSlot(good_->plugin[0]);
    for (int k = 0; k < plugin_->nattribute; ++k) keys_.emplace_back(plugin_->attributes[k]);
  }

  void Try(std::istringstream& lines) {
    mj_copyModel(model_, good_);
    mj_resetData(model_, data_);
    plugin_->destroy(data_, 0);
    char* const text = model_->plugin_attr;
    const auto size = model_->npluginattr;
    std::string values = Values(lines);
    model_->plugin_attr = values.data();
    model_->npluginattr = static_cast<int>(values.size());
    if (plugin_->init(model_, data_, 0) == 0) Run();
    model_->plugin_attr = text;
    model_->npluginattr = size;
    if (data_->plugin_data[0] == 0 && plugin_->init(good_, data_, 0) != 0) std::abort();
  }

 private:
  // As MuJoCo keeps them: the value of each key or nothing, each with a zero at its end.
  std::string Values(std::istringstream& lines) const {
    std::vector<std::string> values(keys_.size());
    for (std::string line; std::getline(lines, line);) {
      const auto key = std::find(keys_.begin(), keys_.end(), line.substr(0, line.find('=')));
      if (key == keys_.end() || line.find('=') == line.npos) continue;
      std::string value = line.substr(line.find('=') + 1);
      std::erase(value, '\0');
      values[key - keys_.begin()] = value;
    }
    std::string all;
    for (const std::string& value : values) all += value + '\0';
    return all;
  }

  void Run() {
    for (int i = 0; i < 3; ++i) {
      for (int u = 0; u < model_->nu; ++u) data_->ctrl[u] = 0.1 * (u + i);
      mj_step(model_, data_);
    }
    mj_inverse(model_, data_);
  }

  mjModel *good_, *model_;
  mjData* data_;
  const mjpPlugin* plugin_;
  std::vector<std::string> keys_;
};

}  // namespace

// Writes good configurations into the folder CONTINUUM_SEEDS, to begin with.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  mju_user_warning = [](const char*) {};
  RegisterEffects();
  const char* const folder = std::getenv("CONTINUUM_SEEDS");
  for (const auto& [law, config] : testing::Laws()) {
    if (folder) std::ofstream(std::filesystem::path(folder) / law) << law << AsLines(config);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static auto& benches = *new std::map<std::string, Bench>;  // until the process ends
  std::istringstream lines{std::string(fuzz::Text(data, size))};
  std::string law;
  std::getline(lines, law);
  if (!testing::Laws().contains(law)) return -1;
  benches.try_emplace(law, law).first->second.Try(lines);
  return 0;
}

}  // namespace continuum
