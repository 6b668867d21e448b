#include "identification/study/row_record.h"

#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/io/file.h"
#include "sim/io/json.h"

namespace continuum {

nlohmann::json ToJson(const RowRecord& r) {
  return {{"input", r.inputs.Hash()},
          {"command", r.inputs.command},
          {"options", r.inputs.options},
          {"version", r.inputs.version},
          {"model", r.inputs.model},
          {"sha256", r.inputs.files},
          {"done", r.reason.empty()},
          {"reason", r.reason},
          {"exit_code", r.exit_code},
          {"seconds", r.seconds},
          {"processor_seconds", r.processor_seconds},
          {"peak_megabytes", r.peak_megabytes},
          {"host", r.host}};
}

RowRecord RecordFrom(const nlohmann::json& json) {
  RowRecord r;
  json.at("command").get_to(r.inputs.command);
  json.at("options").get_to(r.inputs.options);
  json.at("version").get_to(r.inputs.version);
  json.at("model").get_to(r.inputs.model);
  json.at("sha256").get_to(r.inputs.files);
  json.at("reason").get_to(r.reason);
  json.at("exit_code").get_to(r.exit_code);
  json.at("seconds").get_to(r.seconds);
  r.processor_seconds = json.value("processor_seconds", 0.0);
  json.at("peak_megabytes").get_to(r.peak_megabytes);
  json.at("host").get_to(r.host);
  return r;
}

void WriteRecord(const RowRecord& record, const std::filesystem::path& folder) {
  WriteFile(folder / kRowRecord,
            ToJson(record).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

std::optional<RowRecord> ReadRecord(const std::filesystem::path& folder) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(folder / kRowRecord, failed)) return std::nullopt;
  try {
    return RecordFrom(ReadJson(folder / kRowRecord));
  } catch (const Error&) {
    return std::nullopt;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace continuum
