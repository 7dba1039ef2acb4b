#include "client/cli/output.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <utility>

#include <google/protobuf/timestamp.pb.h>
#include <nlohmann/json.hpp>

namespace vs::cli {
namespace {

// Characters, not bytes: what is not the continuation of one in UTF-8.
size_t Width(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string JsonText(const google::protobuf::Message& message, bool indented) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = indented;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
  return status.ok() ? text : nlohmann::json({{"unprintable", status.ToString()}}).dump();
}

}  // namespace

Table::Table(const std::vector<std::string>& names) {
  std::vector<std::string> heading;
  for (const std::string& name : names) {
    right_.push_back(name.starts_with('>'));
    heading.push_back(right_.back() ? name.substr(1) : name);
  }
  rows_.push_back(std::move(heading));
}

void Table::Add(std::vector<std::string> cells) {
  cells.resize(right_.size());
  for (std::string& cell : cells) cell = Printable(cell);
  rows_.push_back(std::move(cells));
}

void Table::Print(std::string_view empty) const {
  if (rows_.size() == 1) {
    std::cout << empty << "\n";
    return;
  }
  std::vector<size_t> widths(right_.size());
  for (const auto& row : rows_) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Width(row[i]));
  }
  for (const auto& row : rows_) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - Width(row[i]), ' ');
      line += right_[i] ? padding + row[i] : row[i] + padding;
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    std::cout << line << "\n";
  }
}

std::string Printable(std::string_view text) {
  std::string clean(text);
  for (char& c : clean) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  // The C1 controls U+0080..U+009F, as UTF-8.
  for (size_t i = 0; i + 1 < clean.size(); ++i) {
    if (clean[i] == '\xC2' && static_cast<unsigned char>(clean[i + 1]) < 0xA0) {
      clean.replace(i, 2, "?");
    }
  }
  return clean;
}

void PrintLine(const std::string& text) { std::cout << Printable(text) << "\n"; }

void PrintJson(const google::protobuf::Message& message, bool indented) {
  std::cout << JsonText(message, indented) << (indented ? "" : "\n");
  if (!indented) std::cout.flush();
}

void PrintJsonObject(
    const std::vector<std::pair<std::string, const google::protobuf::Message*>>& members) {
  nlohmann::ordered_json root;
  for (const auto& [name, message] : members) {
    root[name] = nlohmann::ordered_json::parse(JsonText(*message, false));
  }
  std::cout << root.dump(1) << "\n";
}

void PrintError(const client::Error& error, bool json) {
  if (json) {
    nlohmann::json root = {{"code", client::CodeName(error.code)},
                           {"reason", error.reason},
                           {"message", error.message},
                           {"faults", nlohmann::json::array()}};
    for (const client::Fault& fault : error.faults) {
      root["faults"].push_back({{"subject", fault.subject}, {"message", fault.message}});
    }
    std::cerr << root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
    return;
  }
  std::cerr << "visionctl: " << Printable(error.message) << "\n";
  const bool says_all = error.faults.size() == 1 &&
                        error.message.find(error.faults.front().message) != std::string::npos;
  if (says_all) return;
  for (const client::Fault& fault : error.faults) {
    std::cerr << "  " << Printable(fault.subject + ": " + fault.message) << "\n";
  }
}

std::string TimeText(const google::protobuf::Timestamp& time) {
  if (time.seconds() == 0 && time.nanos() == 0) return "-";
  const std::time_t seconds = time.seconds();
  std::tm local{};
  ::localtime_r(&seconds, &local);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S", &local);
  std::array<char, 8> fraction{};
  std::snprintf(fraction.data(), fraction.size(), ".%03d",
                std::clamp(time.nanos() / 1'000'000, 0, 999));
  return std::string(text.data()) + fraction.data();
}

std::string NumberText(double number, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, number);
  return text.data();
}

}  // namespace vs::cli
