// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/eds/eds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/eds/eds_lines.hpp"

namespace axisgate::profile {
namespace {

constexpr std::int64_t kLastIndex = 0xFFFF, kLastSub = 0xFF;
constexpr std::size_t kIndexDigits = 4;

std::string text_in(const EdsSection& section, const char* key) {
  const auto at = section.keys.find(key);
  return at == section.keys.end() ? std::string() : at->second.text;
}

std::optional<std::int64_t> number_in(Eds& out, const EdsSection& section, const char* key) {
  const auto at = section.keys.find(key);
  if (at == section.keys.end()) return std::nullopt;
  const std::string_view text = eds_bare(at->second.text);
  // What depends on the node-ID is no constant of the type.
  if (text.empty() || eds_lower(text).find("$nodeid") != std::string::npos) return std::nullopt;
  const auto number = eds_number(text);
  if (!number)
    out.remark(at->second.line, fmt::format("{} {} is no number: left out", key, eds_shown(at->second.text)));
  if (number && number->odd)
    out.remark(at->second.line, fmt::format("{} {} is taken for {}", key, eds_shown(text), number->value));
  return number ? std::optional(number->value) : std::nullopt;
}

/// "6099", "6099sub1", "6099suba"; none of [DeviceInfo], [6099Name], [6099Value].
std::optional<ObjectAddress> address_of(std::string_view name) {
  if (name.size() < kIndexDigits) return std::nullopt;
  const auto index = eds_digits(name.substr(0, kIndexDigits), 16);
  if (!index || *index > kLastIndex) return std::nullopt;
  name.remove_prefix(kIndexDigits);
  if (name.empty()) return ObjectAddress{static_cast<std::uint16_t>(*index), 0};
  if (!name.starts_with("sub")) return std::nullopt;
  const auto sub = eds_digits(name.substr(3), 16);
  if (!sub || *sub > kLastSub) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

/// What a profile stands on, said in two ways or in none that can be read.
std::string unclear_in(const EdsSection& section) {
  for (const auto& [key, name] : {std::pair{"datatype", "DataType"}, std::pair{"accesstype", "AccessType"}}) {
    const auto at = section.keys.find(key);
    if (at == section.keys.end()) continue;
    const auto& [text, line, other] = at->second;
    if (!other.empty())
      return fmt::format("{} is {} in line {}, and {} in another one", name, eds_shown(eds_bare(text)), line,
                         eds_shown(eds_bare(other)));
    if (at->first == "datatype" && !eds_bare(text).empty() && !eds_number(eds_bare(text)))
      return fmt::format("{} is {} in line {}, which is no number", name, eds_shown(text), line);
  }
  return {};
}

/// Numbers with a sign are often written as their bytes: 0x80000000.
std::optional<std::int64_t> as_number_of(EdsType type, std::optional<std::int64_t> value) {
  const auto width = width_of(type);
  if (!value || !width || !width->is_signed) return value;
  const std::int64_t span = std::int64_t{1} << (8 * width->size);
  return *value >= span / 2 && *value < span ? *value - span : *value;
}

/// "0 to 0" of makers who fill in every line, and ends that are the wrong way round.
void drop_empty_limits(Eds& out, const EdsSection& section, EdsObject& object) {
  const bool none =
      object.low && object.high && (*object.low > *object.high || (*object.low == 0 && *object.high == 0));
  if (!none) return;
  if (*object.low != 0 || *object.high != 0)
    out.remark(section.line, fmt::format("LowLimit {} and HighLimit {} of [{}] leave no number: left out", *object.low,
                                         *object.high, eds_shown(section.name)));
  object.low = object.high = std::nullopt;
}

EdsObject described(Eds& out, const EdsSection& section) {
  EdsObject object;
  object.section = section.name;
  object.name = text_in(section, "parametername");
  const std::int64_t type = number_in(out, section, "datatype").value_or(0);
  object.type = type > 0 && type <= 0xFFFF ? static_cast<EdsType>(type) : EdsType{0};
  object.access = eds_lower(eds_bare(text_in(section, "accesstype")));
  object.mappable = number_in(out, section, "pdomapping").value_or(0) != 0;
  object.unclear = unclear_in(section);
  // Of a REAL or a number of eight bytes nobody here needs the limits.
  const auto width = width_of(object.type);
  if (object.type != 0 && (!width || width->is_real)) return object;
  object.low = as_number_of(object.type, number_in(out, section, "lowlimit"));
  object.high = as_number_of(object.type, number_in(out, section, "highlimit"));
  drop_empty_limits(out, section, object);
  const char* const value = section.keys.contains("parametervalue") ? "parametervalue" : "defaultvalue";
  object.value = as_number_of(object.type, number_in(out, section, value));
  return object;
}

/// A section of its own counts more than what a compact array says of all.
void put(Eds& out, ObjectAddress address, EdsObject object) {
  if (out.objects.size() >= kMaxEdsObjects) return;
  const std::string lowered = eds_lower(object.section);
  const bool own = address_of(lowered.starts_with("0x") ? lowered.substr(2) : lowered) == address;
  if (own)
    out.objects.insert_or_assign(address, std::move(object));
  else
    out.objects.emplace(address, std::move(object));
}

/// A compact array (CiA 306-1 section 4.6.4): so many values alike, and their number in sub 0.
void spread(Eds& out, std::uint16_t index, const EdsObject& object, std::uint8_t count) {
  constexpr EdsType kUnsigned8 = 0x0005;
  put(out, {index, 0}, {object.section, "NrOfObjects", kUnsigned8, "ro", {}, {}, count, false, ""});
  for (int sub = 1; sub <= count; ++sub) put(out, {index, static_cast<std::uint8_t>(sub)}, object);
}

void read_object(Eds& out, ObjectAddress address, const EdsSection& section, bool is_sub) {
  const std::int64_t count = is_sub ? 0 : number_in(out, section, "compactsubobj").value_or(0);
  // The head of a record has no value of its own: its sub-indexes have sections.
  const bool head = !is_sub && count <= 0 && number_in(out, section, "subnumber").value_or(0) > 0;
  if (head) return;
  EdsObject object = described(out, section);
  if (count > 0) return spread(out, address.index, object, static_cast<std::uint8_t>(std::min(count, kLastSub - 1)));
  put(out, address, std::move(object));
}

void read_objects(const EdsSections& sections, Eds& out) {
  for (const auto& [name, section] : sections) {
    const auto address = address_of(name);
    if (!address) continue;
    if (out.objects.size() >= kMaxEdsObjects) {
      out.faults.push_back({0, "has more objects than " + std::to_string(kMaxEdsObjects)});
      return;
    }
    read_object(out, *address, section, name.size() > kIndexDigits);
  }
}

std::string version_in(const EdsSections& sections) {
  const auto info = sections.find("fileinfo");
  if (info == sections.end()) return {};
  const std::string version(eds_bare(text_in(info->second, "fileversion")));
  const std::string revision(eds_bare(text_in(info->second, "filerevision")));
  return version.empty() || revision.empty() ? version : version + "." + revision;
}

}  // namespace

Eds parse_eds(std::string_view text) {
  Eds out;
  if (text.size() > kMaxEdsBytes) {
    out.faults.push_back({0, "is longer than 4 MiB: is this an EDS?"});
    return out;
  }
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (begin != std::string_view::npos && text[begin] == '<') {
    out.faults.push_back({0, "is an XDD or XDC (XML): ask the drive's maker for the EDS, the same list as plain text"});
    return out;
  }
  const EdsSections sections = eds_sections(text, out);
  read_objects(sections, out);
  if (const auto device = sections.find("deviceinfo"); device != sections.end()) {
    out.vendor_name = text_in(device->second, "vendorname");
    out.product_name = text_in(device->second, "productname");
    out.vendor = number_in(out, device->second, "vendornumber");
    out.product = number_in(out, device->second, "productnumber");
    out.revision = number_in(out, device->second, "revisionnumber");
  }
  out.version = version_in(sections);
  if (out.objects.empty()) out.faults.push_back({0, "has no object: is this an EDS?"});
  std::ranges::stable_sort(out.remarks, {}, &EdsFault::line);
  return out;
}

const EdsObject* Eds::find(ObjectAddress address) const {
  const auto at = objects.find(address);
  return at == objects.end() ? nullptr : &at->second;
}

bool Eds::has_index(std::uint16_t index) const {
  const auto at = objects.lower_bound({index, 0});
  return at != objects.end() && at->first.index == index;
}

std::optional<EdsWidth> width_of(EdsType type) {
  // BOOLEAN is carried as one byte.
  static constexpr auto kWidths = std::to_array<std::pair<EdsType, EdsWidth>>({{0x01, {1, false}},
                                                                               {0x02, {1, true}},
                                                                               {0x03, {2, true}},
                                                                               {0x04, {4, true}},
                                                                               {0x05, {1, false}},
                                                                               {0x06, {2, false}},
                                                                               {0x07, {4, false}},
                                                                               {0x08, {4, true, true}}});
  const auto* const found = std::ranges::find(kWidths, type, [](const auto& row) { return row.first; });
  return found == kWidths.end() ? std::nullopt : std::optional(found->second);
}

std::string eds_type_name(EdsType type) {
  static constexpr auto kNames = names_of<EdsType>({
      {0x01, "BOOLEAN"},         {0x02, "INTEGER8"},     {0x03, "INTEGER16"},      {0x04, "INTEGER32"},
      {0x05, "UNSIGNED8"},       {0x06, "UNSIGNED16"},   {0x07, "UNSIGNED32"},     {0x08, "REAL32"},
      {0x09, "VISIBLE_STRING"},  {0x0A, "OCTET_STRING"}, {0x0B, "UNICODE_STRING"}, {0x0C, "TIME_OF_DAY"},
      {0x0D, "TIME_DIFFERENCE"}, {0x0F, "DOMAIN"},       {0x10, "INTEGER24"},      {0x11, "REAL64"},
      {0x15, "INTEGER64"},       {0x16, "UNSIGNED24"},   {0x1B, "UNSIGNED64"},
  });
  const std::string_view name = kNames.of(type, "");
  return name.empty() ? fmt::format("type 0x{:04X}", type) : std::string(name);
}

}  // namespace axisgate::profile
