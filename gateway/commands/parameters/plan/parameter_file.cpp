// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/parameters/plan/parameter_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/model/real32.hpp"
#include "gateway/profile/json/json_node.hpp"
#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::commands {
namespace {

using profile::JsonNode;
using Json = nlohmann::ordered_json;

constexpr std::array kIdentity{"vendor", "product", "revision", "serial"};
constexpr const char* kModbus = "modbus-rtu";
/// The form of the file; another one is of a newer axisgate.
constexpr int kForm = 1;

std::optional<std::uint32_t> number_in(std::string_view digits, int base, std::uint32_t most) {
  std::uint32_t out = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out, base);
  const bool whole = error == std::errc() && end == digits.data() + digits.size();
  return whole && out <= most ? std::optional(out) : std::nullopt;
}

std::optional<ObjectAddress> address_in(const std::string& protocol, std::string_view text) {
  constexpr std::uint32_t kIndex = 0xFFFF, kSub = 0xFF;
  constexpr std::size_t kDigits = 4;
  if (protocol == kModbus) {
    const auto index = number_in(text, 10, kIndex);
    return index ? std::optional(ObjectAddress{static_cast<std::uint16_t>(*index)}) : std::nullopt;
  }
  if (text.size() != kDigits + 3 || text[kDigits] != '.') return std::nullopt;
  const auto index = number_in(text.substr(0, kDigits), 16, kIndex);
  const auto sub = number_in(text.substr(kDigits + 1), 16, kSub);
  if (!index || !sub) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

/// "u16", "i8", "f32".
std::optional<model::ObjectDef> object_of_type(const std::string& type) {
  for (const std::uint8_t size : std::to_array<std::uint8_t>({1, 2, 4}))
    for (const bool is_signed : {false, true})
      for (const bool is_real : {false, true}) {
        if ((is_real && (is_signed || size != 4)) || model::type_name(size, is_signed, is_real) != type) continue;
        model::ObjectDef out;
        out.size = size;
        out.is_signed = is_signed;
        out.is_real = is_real;
        return out;
      }
  return std::nullopt;
}

Json json_of(const SavedParameter& saved, const std::string& protocol) {
  Json out{{"at", place_text(protocol, saved.address)}, {"name", saved.name}, {"type", saved.type}};
  if (!saved.reading.number)
    out["unread"] = saved.reading.why;
  else if (saved.type == "f32")
    out["value"] = std::bit_cast<float>(model::bits_of_real(*saved.reading.number));
  else
    out["value"] = *saved.reading.number;
  return out;
}

class Reader {
 public:
  explicit Reader(const nlohmann::json& document) : document_(document), root_(document, "") {}

  ParameterFile read() {
    ParameterFile out;
    if (root_["parameters"].integer() != kForm)
      fault("/parameters",
            fmt::format("must be {}: it is no file of axisgate parameters save, or of a newer one", kForm));
    out.version = root_.text("axisgate");
    out.at = root_.text("at");
    out.axis = static_cast<unsigned>(root_.whole("axis", 0));
    out.axis_name = root_.text("axis_name");
    out.drive = {root_.text("profile"),
                 root_.text("title"),
                 root_.text("protocol"),
                 static_cast<unsigned>(root_.whole("node", 0)),
                 {},
                 profile::plain_text(root_.text("firmware"))};
    for (const char* key : {"profile", "protocol"})
      if (root_.text(key).empty()) fault(profile::pointer_to("", key), "is missing: whose parameters are these?");
    read_identity(out.drive);
    const std::vector<JsonNode> objects = root_["objects"].elements();
    if (objects.empty()) fault("/objects", "there are none");
    if (objects.size() > kMaxParameters) fault("/objects", fmt::format("are more than {}", kMaxParameters));
    if (faults.empty())
      for (const JsonNode& node : objects) read_object(out, node);
    return out;
  }
  std::vector<profile::SchemaFault> faults;

 private:
  void fault(const std::string& pointer, std::string message) { faults.push_back({pointer, std::move(message)}); }

  void read_identity(DriveFacts& drive) {
    const JsonNode identity = root_["identity"];
    for (std::size_t i = 0; i < kIdentity.size(); ++i) {
      if (!identity.has(kIdentity[i])) continue;
      const auto number = identity[kIdentity[i]].whole();
      if (!number || *number < 0 || *number > UINT32_MAX)
        fault(identity.pointer(kIdentity[i]), "must be a number of 32 bits");
      else
        drive.identity[i] = static_cast<std::uint32_t>(*number);
    }
  }

  void read_object(ParameterFile& out, const JsonNode& node) {
    const auto address = address_in(out.drive.protocol, node.text("at"));
    const auto type = object_of_type(node.text("type"));
    if (!address) {
      const bool modbus = out.drive.protocol == kModbus;
      return fault(node.pointer("at"), modbus ? "must be a register, such as \"296\""
                                              : "must be index and sub-index in hexadecimal, such as \"2010.03\"");
    }
    if (!type) return fault(node.pointer("type"), "must be one of u8, i8, u16, i16, u32, i32, f32");
    if (!seen_.insert(*address).second) return fault(node.pointer("at"), "stands in the file twice");
    SavedParameter saved{*address, profile::plain_text(node.text("name")), node.text("type")};
    if (node.has("value"))
      saved.reading.number = value_in(node, *type);
    else
      saved.reading.why = profile::plain_text(node.text("unread"));
    if (!node.has("value") && saved.reading.why.empty())
      return fault(node.pointer(), "needs \"value\", or \"unread\" with the reason");
    out.objects.push_back(std::move(saved));
  }

  std::optional<std::int64_t> value_in(const JsonNode& node, const model::ObjectDef& type) {
    const std::string pointer = node.pointer("value");
    if (type.is_real) {
      const auto& value = document_.at(nlohmann::json::json_pointer(pointer));
      const auto real = value.is_number() ? value.get<float>() : std::nanf("");
      if (std::isfinite(real)) return model::real_of_bits(std::bit_cast<std::uint32_t>(real));
      fault(pointer, "must be a number");
      return std::nullopt;
    }
    const auto number = node["value"].integer();
    if (number && type.range().holds(*number)) return number;
    fault(pointer, fmt::format("must be a whole number of {} to {}", type.range().min, type.range().max));
    return std::nullopt;
  }

  const nlohmann::json& document_;
  JsonNode root_;
  std::set<ObjectAddress> seen_;
};

}  // namespace

std::string place_text(const std::string& protocol, ObjectAddress address) {
  if (protocol == kModbus) return fmt::format("{}", address.index);
  return fmt::format("{:04X}.{:02X}", address.index, address.sub);
}

std::string type_text(const model::ObjectDef& object) {
  return model::type_name(object.size, object.is_signed, object.is_real);
}

std::string number_text(const model::ObjectDef& object, std::int64_t number) {
  if (object.is_real) return fmt::format("{}", std::bit_cast<float>(model::bits_of_real(number)));
  return fmt::format("{}", number);
}

std::string json_text(const ParameterFile& file) {
  Json out{{"parameters", kForm},        {"axisgate", file.version},        {"at", file.at},
           {"axis", file.axis},          {"axis_name", file.axis_name},     {"profile", file.drive.profile},
           {"title", file.drive.title},  {"protocol", file.drive.protocol}, {"node", file.drive.node},
           {"identity", Json::object()}, {"firmware", file.drive.firmware}};
  for (std::size_t i = 0; i < kIdentity.size(); ++i)
    if (file.drive.identity[i]) out["identity"][kIdentity[i]] = *file.drive.identity[i];
  Json& objects = out["objects"] = Json::array();
  for (const SavedParameter& saved : file.objects) objects.push_back(json_of(saved, file.drive.protocol));
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::variant<ParameterFile, std::vector<profile::SchemaFault>> parse_parameter_file(const std::string& text) {
  const auto read = profile::parse_json(text);
  if (const auto* fault = std::get_if<profile::SchemaFault>(&read)) return std::vector{*fault};
  Reader reader(std::get<nlohmann::json>(read));
  ParameterFile out = reader.read();
  if (!reader.faults.empty()) return std::move(reader.faults);
  return out;
}

}  // namespace axisgate::commands
