#include "sim/model/mjcf_document.h"

#include <algorithm>
#include <sstream>

#include "error.h"

namespace continuum {
namespace {

// Everything is kept as it is written, white space and escapes too.
constexpr unsigned kParse = (pugi::parse_full | pugi::parse_ws_pcdata | pugi::parse_fragment) &
                            ~(pugi::parse_escapes | pugi::parse_eol | pugi::parse_wconv_attribute);
constexpr unsigned kFormat =
    pugi::format_raw | pugi::format_no_escapes | pugi::format_no_declaration;

// An attribute's value with the escapes that MuJoCo writes.
std::string Escaped(const std::string& value) {
  std::string text;
  for (const char c : value) {
    switch (c) {
      case '&':
        text += "&amp;";
        break;
      case '<':
        text += "&lt;";
        break;
      case '>':
        text += "&gt;";
        break;
      case '"':
        text += "&quot;";
        break;
      case '\'':
        text += "&apos;";
        break;
      default:
        text += c;
    }
  }
  return text;
}

void SetAttribute(pugi::xml_node element, const char* name, const std::string& value) {
  pugi::xml_attribute attribute = element.attribute(name);
  if (!attribute) attribute = element.append_attribute(name);
  attribute.set_value(Escaped(value).c_str());
}

// The end of a line and the white space that begins the next.
std::string Break(int indent) { return "\n" + std::string(indent, ' '); }

void AppendText(pugi::xml_node element, const std::string& text) {
  element.append_child(pugi::node_pcdata).set_value(text.c_str());
}

// Adds a child as the last line of an element, which is indented by so many spaces itself.
pugi::xml_node AppendLine(pugi::xml_node element, int indent, const char* name) {
  if (element.last_child().type() != pugi::node_pcdata) AppendText(element, Break(indent));
  pugi::xml_node end = element.last_child();
  element.insert_child_before(pugi::node_pcdata, end).set_value(Break(indent + 2).c_str());
  return element.insert_child_before(name, end);
}

}  // namespace

MjcfDocument::MjcfDocument(const std::string& xml) {
  const auto parsed = document_.load_buffer(xml.data(), xml.size(), kParse, pugi::encoding_utf8);
  if (!parsed) throw Error::Job(std::string("MJCF: ") + parsed.description());
  if (!Root()) throw Error::Job("MJCF: there is no element 'mujoco'");
}

pugi::xml_node MjcfDocument::Instance(const std::string& name) const {
  for (const pugi::xml_node extension : Root().children("extension")) {
    for (const pugi::xml_node plugin : extension.children("plugin")) {
      const auto found = plugin.find_child_by_attribute("instance", "name", Escaped(name).c_str());
      if (found) return found;
    }
  }
  throw Error::Input("plugin:" + name, "an instance in the MJCF", "none");
}

void MjcfDocument::AddInstance(const EffectInstance& effect) {
  pugi::xml_node extension = Root().child("extension");
  if (!extension) {
    pugi::xml_node root = Root();
    root.prepend_child(pugi::node_pcdata).set_value("\n");
    extension = root.prepend_child("extension");
    root.prepend_child(pugi::node_pcdata).set_value(Break(2).c_str());
  }
  const pugi::xml_node plugin = AppendLine(extension, 2, "plugin");
  SetAttribute(plugin, "plugin", "continuum." + effect.effect);
  const pugi::xml_node instance = AppendLine(plugin, 4, "instance");
  SetAttribute(instance, "name", effect.name);
  for (const auto& [key, value] : effect.config) {
    const pugi::xml_node config = AppendLine(instance, 6, "config");
    SetAttribute(config, "key", key);
    SetAttribute(config, "value", value);
  }
}

void MjcfDocument::SetConfig(const std::string& instance, const std::string& key,
                             const std::string& value) {
  const pugi::xml_node element = Instance(instance);
  pugi::xml_node config = element.find_child_by_attribute("config", "key", Escaped(key).c_str());
  if (!config) {
    config = AppendLine(element, 6, "config");
    SetAttribute(config, "key", key);
  }
  SetAttribute(config, "value", value);
}

std::vector<pugi::xml_node> MjcfDocument::References(const std::string& instance) const {
  std::vector<pugi::xml_node> references;
  for (const pugi::xpath_node& plugin : Root().select_nodes("worldbody//body/plugin")) {
    if (plugin.node().attribute("instance").value() == Escaped(instance))
      references.push_back(plugin.node());
  }
  return references;
}

void MjcfDocument::ReplaceInstance(const std::string& instance, const EffectInstance& by) {
  const auto references = References(instance);
  for (pugi::xml_node body : references) {
    SetAttribute(body, "plugin", "continuum." + by.effect);
    SetAttribute(body, "instance", by.name);
  }
  EraseInstance(instance);
  AddInstance(by);
}

void MjcfDocument::RemoveInstance(const std::string& instance) {
  EraseInstance(instance);
  for (pugi::xml_node body : References(instance)) body.parent().remove_child(body);
}

void MjcfDocument::EraseInstance(const std::string& instance) {
  const pugi::xml_node element = Instance(instance);
  pugi::xml_node plugin = element.parent();
  plugin.remove_child(element);
  if (!plugin.child("instance")) plugin.parent().remove_child(plugin);
}

std::string MjcfDocument::Text() const {
  std::ostringstream out;
  document_.save(out, "", kFormat, pugi::encoding_utf8);
  return out.str();
}

// What is no XML is left to MuJoCo, which says so.
void RefuseEmptyConfig(const std::string& xml, const std::string& file) {
  pugi::xml_document document;
  document.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
  const pugi::xml_node config = document.select_node("//config[@value='']").node();
  if (!config) return;
  const auto line = 1 + std::count(xml.begin(), xml.begin() + config.offset_debug(), '\n');
  throw Error::Input(
      file + ":" + std::to_string(line) + ": config '" + config.attribute("key").value() + "'",
      "a value", "''");
}

}  // namespace continuum
