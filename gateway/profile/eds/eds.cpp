// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/eds/eds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "gateway/core/name_table.hpp"

namespace axisgate::profile {
namespace {

constexpr std::size_t kMaxLine = 4096;  // CiA 306 allows 255
constexpr std::int64_t kLastIndex = 0xFFFF, kLastSub = 0xFF;

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// What may be printed in a message: a damaged file's bytes would spoil a terminal.
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out;
  for (const char c : text.substr(0, kMost)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > kMost ? out + "..." : out;
}

std::optional<std::int64_t> digits(std::string_view text, int base) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size() || value > INT64_MAX) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

/// "47", "0x2F", "057", "-1".
std::optional<std::int64_t> number(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  const bool octal = !hex && text.size() > 1 && text.front() == '0';
  const auto value = digits(hex ? text.substr(2) : text, hex ? 16 : octal ? 8 : 10);
  return value && negative ? std::optional(-*value) : value;
}

struct Value {
  std::string text;
  std::size_t line = 0;
};

struct Section {
  std::string name;  ///< as written
  std::size_t line = 0;
  std::map<std::string, Value> keys;  ///< in small letters
};

/// The lines of the file, put into sections by name in small letters.
class Sections {
 public:
  explicit Sections(std::vector<EdsFault>& faults) : faults_(faults) {}

  void read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::size_t line = 0;
    while (!text.empty() && faults_.size() < kMaxEdsFaults) {
      const std::size_t end = text.find('\n');
      take(trimmed(text.substr(0, end)), ++line);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
  }

  [[nodiscard]] const std::map<std::string, Section>& all() const { return sections_; }
  [[nodiscard]] const Section* find(const std::string& name) const {
    const auto at = sections_.find(name);
    return at == sections_.end() ? nullptr : &at->second;
  }

 private:
  void take(std::string_view line, std::size_t number) {
    if (line.empty() || line.front() == ';' || line.front() == '#') return;
    if (line.size() > kMaxLine) return fault(number, "the line is longer than any EDS has them");
    if (line.find('\0') != std::string_view::npos) return fault(number, "has bytes that are no text: is this an EDS?");
    if (line.front() == '[') return open(line, number);
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos)
      return fault(number, "\"" + shown(line) + "\" is neither [section] nor key=value");
    if (current_ == nullptr) return fault(number, "\"" + shown(line) + "\" stands before the first [section]");
    const std::string key = lower(trimmed(line.substr(0, equals)));
    Value value{std::string(trimmed(line.substr(equals + 1))), number};
    if (!current_->keys.emplace(key, std::move(value)).second)
      fault(number, "key " + shown(key) + " is given twice in [" + shown(current_->name) + "]");
  }

  void open(std::string_view line, std::size_t number) {
    const std::size_t end = line.find(']');
    if (end == std::string_view::npos) return fault(number, "\"" + shown(line) + "\" is a section without its ]");
    const std::string_view name = trimmed(line.substr(1, end - 1));
    const auto [at, first] = sections_.emplace(lower(name), Section{std::string(name), number, {}});
    if (!first)
      fault(number, "section [" + shown(name) + "] is there already, in line " + std::to_string(at->second.line));
    current_ = &at->second;
  }

  void fault(std::size_t line, std::string message) { faults_.push_back({line, std::move(message)}); }

  std::vector<EdsFault>& faults_;
  std::map<std::string, Section> sections_;
  Section* current_ = nullptr;
};

std::string text_in(const Section& section, const char* key) {
  const auto at = section.keys.find(key);
  return at == section.keys.end() ? std::string() : at->second.text;
}

/// Turns sections into objects.
class Objects {
 public:
  Objects(const Sections& sections, Eds& out) : sections_(sections), out_(out) {}

  void read() {
    for (const auto& [name, section] : sections_.all()) {
      if (out_.faults.size() >= kMaxEdsFaults) return;
      const auto address = address_of(name);
      if (!address) continue;
      if (out_.objects.size() >= kMaxEdsObjects)
        return fault(0, "has more objects than " + std::to_string(kMaxEdsObjects));
      read_object(*address, section, name.size() > kIndexDigits);
    }
  }

  [[nodiscard]] std::optional<std::int64_t> number_in(const Section& section, const char* key) {
    const auto at = section.keys.find(key);
    if (at == section.keys.end()) return std::nullopt;
    const std::string_view text = trimmed(std::string_view(at->second.text).substr(0, at->second.text.find(';')));
    // What depends on the node-ID is no constant of the type.
    if (text.empty() || lower(text).find("$nodeid") != std::string::npos) return std::nullopt;
    const auto value = number(text);
    if (!value) fault(at->second.line, shown(at->second.text) + " is no number");
    return value;
  }

 private:
  static constexpr std::size_t kIndexDigits = 4;

  /// "6099", "6099sub1", "6099suba"; none of [DeviceInfo], [6099Name], [6099Value].
  static std::optional<ObjectAddress> address_of(std::string_view name) {
    if (name.size() < kIndexDigits) return std::nullopt;
    const auto index = digits(name.substr(0, kIndexDigits), 16);
    if (!index || *index > kLastIndex) return std::nullopt;
    name.remove_prefix(kIndexDigits);
    if (name.empty()) return ObjectAddress{static_cast<std::uint16_t>(*index), 0};
    if (!name.starts_with("sub")) return std::nullopt;
    const auto sub = digits(name.substr(3), 16);
    if (!sub || *sub > kLastSub) return std::nullopt;
    return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
  }

  void read_object(ObjectAddress address, const Section& section, bool is_sub) {
    EdsObject object = described(section);
    const std::int64_t count = is_sub ? 0 : number_in(section, "compactsubobj").value_or(0);
    if (count > 0) return spread(address.index, object, static_cast<std::uint8_t>(std::min(count, kLastSub - 1)));
    // The head of a record has no value of its own: its sub-indexes have sections.
    if (!is_sub && number_in(section, "subnumber").value_or(0) > 0) return;
    put(address, std::move(object));
  }

  EdsObject described(const Section& section) {
    EdsObject out;
    out.section = section.name;
    out.name = text_in(section, "parametername");
    const std::int64_t type = number_in(section, "datatype").value_or(0);
    out.type = type > 0 && type <= 0xFFFF ? static_cast<EdsType>(type) : EdsType{0};
    out.access = lower(text_in(section, "accesstype"));
    out.low = as_number_of(out.type, number_in(section, "lowlimit"));
    out.high = as_number_of(out.type, number_in(section, "highlimit"));
    out.mappable = number_in(section, "pdomapping").value_or(0) != 0;
    return out;
  }

  /// A compact array (CiA 306-1 section 4.6.4): so many values alike, and their number in sub 0.
  void spread(std::uint16_t index, const EdsObject& object, std::uint8_t count) {
    constexpr EdsType kUnsigned8 = 0x0005;
    put({index, 0}, {object.section, "NrOfObjects", kUnsigned8, "ro", std::nullopt, std::nullopt, false});
    for (int sub = 1; sub <= count; ++sub) put({index, static_cast<std::uint8_t>(sub)}, object);
  }

  /// A section of its own counts more than what a compact array says of all.
  void put(ObjectAddress address, EdsObject object) {
    if (out_.objects.size() >= kMaxEdsObjects) return;
    const bool own = address_of(lower(object.section)) == address;
    if (own)
      out_.objects.insert_or_assign(address, std::move(object));
    else
      out_.objects.emplace(address, std::move(object));
  }

  /// Limits of signed numbers are often written as their bytes: 0x80000000.
  static std::optional<std::int64_t> as_number_of(EdsType type, std::optional<std::int64_t> value) {
    const auto width = width_of(type);
    if (!value || !width || !width->is_signed) return value;
    const std::int64_t span = std::int64_t{1} << (8 * width->size);
    return *value >= span / 2 && *value < span ? *value - span : *value;
  }

  void fault(std::size_t line, std::string message) {
    if (out_.faults.size() < kMaxEdsFaults) out_.faults.push_back({line, std::move(message)});
  }

  const Sections& sections_;
  Eds& out_;
};

}  // namespace

Eds parse_eds(std::string_view text) {
  Eds out;
  if (text.size() > kMaxEdsBytes) {
    out.faults.push_back({0, "is longer than 4 MiB: is this an EDS?"});
    return out;
  }
  Sections sections(out.faults);
  sections.read(text);
  Objects objects(sections, out);
  objects.read();
  if (const Section* device = sections.find("deviceinfo")) {
    out.vendor_name = text_in(*device, "vendorname");
    out.product_name = text_in(*device, "productname");
    out.vendor = objects.number_in(*device, "vendornumber");
    out.product = objects.number_in(*device, "productnumber");
    out.revision = objects.number_in(*device, "revisionnumber");
  }
  if (out.objects.empty() && out.faults.empty()) out.faults.push_back({0, "has no object: is this an EDS?"});
  return out;
}

std::optional<EdsWidth> width_of(EdsType type) {
  // BOOLEAN is carried as one byte.
  static constexpr auto kWidths = std::to_array<std::pair<EdsType, EdsWidth>>({{0x01, {1, false}},
                                                                               {0x02, {1, true}},
                                                                               {0x03, {2, true}},
                                                                               {0x04, {4, true}},
                                                                               {0x05, {1, false}},
                                                                               {0x06, {2, false}},
                                                                               {0x07, {4, false}}});
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
