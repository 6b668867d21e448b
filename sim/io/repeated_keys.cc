#include "sim/io/repeated_keys.h"

#include <yaml-cpp/yaml.h>

#include <map>
#include <sstream>
#include <vector>

#include <yaml-cpp/eventhandler.h>

#include "error.h"
#include "sim/io/excerpt.h"

namespace continuum {
namespace {

// Reads the text as events: aliases are not followed, so a file that repeats itself or contains
// itself costs no more than its length.
class Keys : public YAML::EventHandler {
 public:
  explicit Keys(const std::string& name) : name_(name) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override { Item(); }
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override { Item(); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    if (IsKey()) Add(mark.line + 1, value);
    Item();
  }
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    Item();
    open_.push_back({.is_map = false});
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    Item();
    open_.push_back({.is_map = true});
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Collection {
    bool is_map = false;
    std::size_t items = 0;                 // keys and values so far
    std::map<std::string, int> keys = {};  // with their lines
  };

  bool IsKey() const {
    return !open_.empty() && open_.back().is_map && open_.back().items % 2 == 0;
  }

  void Item() {
    if (!open_.empty()) ++open_.back().items;
  }

  void Add(int line, const std::string& key) {
    const auto [first, added] = open_.back().keys.emplace(key, line);
    if (added) return;
    throw Error::Input(
        name_ + ":" + std::to_string(line), "different keys",
        "'" + Shown(key) + "' twice, first in line " + std::to_string(first->second));
  }

  const std::string& name_;
  std::vector<Collection> open_;
};

}  // namespace

void RefuseRepeatedKeys(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Keys keys(name);
  parser.HandleNextDocument(keys);
}

}  // namespace continuum
