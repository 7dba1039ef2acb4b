#include "server/results/result_csv.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <ctime>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr std::string_view kFixedColumns =
    "number,result_id,job_id,part_id,meas_id,sequence_revision,parameter_hash,frame_number,"
    "creation_time,acquisition_time,processing_ms,result_state,result_class,reason";

std::string TimeText(int64_t utc_ns) {
  if (utc_ns == 0) return "";
  const std::time_t seconds = utc_ns / 1'000'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 24> date{};
  std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%s.%06dZ", date.data(),
                static_cast<int>(utc_ns / 1000 % 1'000'000));
  return text.data();
}

// Numbers in the shortest form that reads back as the same number.
std::string ValueText(const ParamValue& value) {
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr) return CsvField(ToString(value));
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), *number);
  return std::string(text.data(), end.ptr);
}

std::string MillisecondsText(int64_t ns) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3f", static_cast<double>(ns) / 1e6);
  return text.data();
}

}  // namespace

std::string CsvField(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

ResultCsv::ResultCsv(const std::set<std::string>& field_names)
    : field_names_(field_names.begin(), field_names.end()) {}

std::string ResultCsv::Header() const {
  std::string line(kFixedColumns);
  for (const std::string& name : field_names_) line += ',' + CsvField(name);
  return line + "\r\n";
}

std::string ResultCsv::Row(const StoredResult& result) const {
  const ResultRecord& record = result.record;
  std::string line =
      Str(result.number, ',', result.result_id, ',', CsvField(record.job_id), ',',
          CsvField(record.part_id), ',', CsvField(record.meas_id), ',', record.sequence_revision,
          ',', ParameterHashText(record.parameter_hash), ',', record.frame_number, ',',
          TimeText(result.creation_time_ns), ',', TimeText(result.acquisition_time_ns), ',',
          MillisecondsText(record.processing_ns), ',', ResultStateName(record.state), ',',
          ResultClassName(record.result_class), ',', CsvField(record.reason));
  for (const std::string& name : field_names_) {
    line += ',';
    const auto found = record.values.find(name);
    if (found != record.values.end()) line += ValueText(found->second);
  }
  return line + "\r\n";
}

}  // namespace vs
