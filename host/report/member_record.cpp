#include "report/member_record.hpp"

#include <filesystem>

#include "data/text.hpp"
#include "report/json_values.hpp"

namespace quadedge::report {
namespace {

constexpr int kMemberSchema = 1;  // grows when a key changes its meaning

}  // namespace

std::string member_json(const MemberRecord& record) {
  Json json;
  json["schema"] = kMemberSchema;
  json["name"] = record.name;
  json["path"] = record.path;
  json["format"] = record.format;
  json["key"] = record.key;
  json["exit_code"] = record.exit_code;
  json["message"] = record.message;
  json["jobs"] = record.jobs;
  return json_text(json);
}

std::optional<MemberRecord> read_member(const std::string& folder) {
  const std::string file = folder + "/member.json";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  try {
    const auto json = Json::parse(data::read_bytes(file));
    if (json.at("schema") != kMemberSchema) return std::nullopt;
    MemberRecord record;
    record.name = json.at("name");
    record.path = json.at("path");
    record.format = json.at("format");
    record.key = json.at("key");
    record.exit_code = json.at("exit_code");
    record.message = json.at("message");
    record.jobs = json.at("jobs");
    return record;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace quadedge::report
