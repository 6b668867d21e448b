#include "sim/model/model_files.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <pugixml.hpp>

#include "sim/io/file.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

class Walk {
 public:
  explicit Walk(const fs::path& model) : folder_(model.parent_path()) { Visit(model); }

  std::vector<fs::path> files;

 private:
  void Visit(const fs::path& file) {
    const fs::path plain = file.lexically_normal();
    if (std::find(files.begin(), files.end(), plain) != files.end()) return;
    files.push_back(plain);
    const std::string text = ReadFile(file);
    pugi::xml_document document;
    if (!document.load_buffer(text.data(), text.size())) return;  // no XML
    std::vector<fs::path> folders{folder_, file.parent_path()};
    for (const auto& compiler : document.select_nodes("//compiler")) {
      for (const char* key : {"assetdir", "meshdir", "texturedir"}) {
        if (const auto attribute = compiler.node().attribute(key))
          folders.push_back(folder_ / attribute.value());
      }
    }
    VisitNamed(document, folders);
  }

  // Attributes are called file, fileright, fileup, ...
  void VisitNamed(const pugi::xml_document& document, const std::vector<fs::path>& folders) {
    for (const auto& found : document.select_nodes("//@*[starts-with(name(), 'file')]")) {
      for (const fs::path& folder : folders) {
        const fs::path named = folder / found.attribute().value();
        std::error_code failed;
        if (fs::is_regular_file(named, failed)) Visit(named);
      }
    }
  }

  fs::path folder_;  // of the main model, which relative names start from
};

}  // namespace

std::vector<fs::path> FilesOfModel(const fs::path& model) { return Walk(model).files; }

}  // namespace continuum
