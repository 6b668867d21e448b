#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace continuum {

/// A node of a YAML file that knows where it stands: every error names file, line and key.
class Yaml {
 public:
  static Yaml Read(const std::filesystem::path& file);
  /// name stands for the file in messages.
  static Yaml Parse(const std::string& text, std::string name);

  const YAML::Node& node() const { return node_; }
  const std::string& file() const { return file_; }
  /// "file:line: a.b[2]"
  std::string Where() const;
  /// What stands here, for messages: "nothing", "a map", "a list" or 'the text'.
  std::string Found() const;

  bool Has(const std::string& key) const;
  /// Throws Error when this is no map or the key is missing.
  Yaml At(const std::string& key) const;
  std::optional<Yaml> Find(const std::string& key) const;
  /// The items of a list; throws Error when this is none.
  std::vector<Yaml> Items() const;
  /// The keys of a map in file order; throws Error when this is none.
  std::vector<std::string> Keys() const;
  /// Throws Error, listing what is allowed, when this map has any other key.
  void Only(std::initializer_list<std::string_view> keys) const;

  bool IsMap() const { return node_.IsMap(); }
  bool IsList() const { return node_.IsSequence(); }
  bool IsScalar() const { return node_.IsScalar(); }
  std::string Text() const;
  /// The text at a key of a map, or the fallback where the key is absent.
  std::string TextOr(const std::string& key, const std::string& fallback) const;
  /// The value of the option that the text names; throws Error, listing all, for another text.
  template <class T>
  T OneOf(const std::vector<std::pair<std::string, T>>& options) const;
  /// The file of this name, from the folder of the YAML file; throws Error when there is none.
  std::filesystem::path File(const std::string& expected) const;
  double Number() const;  ///< finite
  double Number(double lower, double upper) const;
  /// The number at a key of a map, or the fallback where the key is absent.
  double NumberOr(const std::string& key, double fallback) const;
  double NumberOr(const std::string& key, double fallback, double lower, double upper) const;
  int Integer() const;
  bool Bool() const;
  std::vector<double> Numbers() const;
  /// A parameter of a robot's file: a number, or a map {value, unit, uncertainty, source}.
  Yaml Quantity()
      const;  ///< `value` of a map that has one, whose `unit` must be of the SI; else this
  double Parameter() const;
  double Parameter(double lower, double upper) const;
  std::vector<double> Parameters() const;

 private:
  Yaml(YAML::Node node, std::string file, std::string path)
      : node_(std::move(node)), file_(std::move(file)), path_(std::move(path)) {}

  /// Throws Error: one of the options was expected here.
  [[noreturn]] void RefuseOption(const std::string& options) const;

  YAML::Node node_;
  std::string file_, path_;
};

template <class T>
T Yaml::OneOf(const std::vector<std::pair<std::string, T>>& options) const {
  const std::string text = Text();
  std::string all;
  for (const auto& [name, value] : options) {
    if (text == name) return value;
    all += (all.empty() ? "" : " | ") + name;
  }
  RefuseOption(all);
}

}  // namespace continuum
