// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/eds/eds_compare.hpp"

#include <fmt/format.h>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {
namespace {

constexpr std::string_view kCanopen = "canopen";
/// CiA 301: TPDO parameters and mapping, and the sub-indexes of what a profile may set.
constexpr std::uint16_t kFirstTpdo = 0x1800, kFirstMapping = 0x1A00;
constexpr std::uint8_t kInhibit = 3, kEventTimer = 5;

/// As a section of it would be called.
std::string section_of(ObjectAddress address) {
  const std::string index = fmt::format("{:04X}", address.index);
  return address.sub == 0 ? index : fmt::format("{}sub{:X}", index, address.sub);
}

std::string type_text(const Place& place) { return model::type_name(place.size, place.is_signed, place.is_real); }

std::string limit_text(const std::optional<std::int64_t>& limit) { return limit ? std::to_string(*limit) : "none"; }

class Comparison {
 public:
  Comparison(const Profile& profile, const Eds& eds) : profile_(profile), eds_(eds) {}

  std::vector<EdsContradiction> run() {
    for (const Object& object : profile_.objects) compare(object);
    const auto protocol = profile_.protocols.find(kCanopen);
    if (protocol != profile_.protocols.end()) {
      compare_tpdos(protocol->second.canopen);
      if (const LossSpec& loss = protocol->second.loss; loss.by == LossSpec::By::life_guarding)
        compare_value(loss.object, loss.value, "/protocols/canopen/loss/value");
    }
    for (const JsonNode& write : profile_.section("setup").elements()) compare_setup(write);
    return std::move(out_);
  }

 private:
  void say(std::string pointer, std::string section, std::string message) {
    out_.push_back({std::move(pointer), std::move(section), std::move(message)});
  }

  void compare(const Object& object) {
    const Place* place = object.place(kCanopen);
    if (place == nullptr || object.is_part()) return;
    const std::string at = pointer_to(pointer_to(object.pointer, "at"), kCanopen);
    const EdsObject* known = eds_.find(place->address);
    if (known == nullptr)
      return say(at, section_of(place->address),
                 eds_.has_index(place->address.index) ? "the EDS has this index, but not this sub-index"
                                                      : "the EDS has no such object");
    if (!known->unclear.empty()) return say(at, known->section, known->unclear);
    compare_type(object, *place, *known);
    compare_access(object, *known);
    if (object.printed.min != INT64_MIN) compare_range(pointer_to(object.pointer, "range"), object.printed, *known);
  }

  void compare_type(const Object& object, const Place& place, const EdsObject& known) {
    const std::string at = pointer_to(object.pointer, "type");
    if (known.type == 0) return say(at, known.section, "has no DataType in the EDS");
    const auto width = width_of(known.type);
    const bool fits = width && (object.any_width ? width->size <= place.size : width->size == place.size);
    if (!fits || width->is_signed != place.is_signed || width->is_real != place.is_real)
      say(at, known.section, fmt::format("is {} here, {} in the EDS", type_text(place), eds_type_name(known.type)));
  }

  void compare_access(const Object& object, const EdsObject& known) {
    if (known.access.empty()) return;
    const std::string at = pointer_to(object.pointer, "access");
    const bool reads = known.access != "wo";
    const bool writes = known.access.starts_with("rw") || known.access == "wo";  // rwr, rww: mapped one way only
    if (object.readable && !reads) say(at, known.section, "is read here, " + known.access + " in the EDS");
    if (object.writable && !writes) say(at, known.section, "is written here, " + known.access + " in the EDS");
  }

  void compare_range(const std::string& at, const Range& range, const EdsObject& known) {
    if (known.low && range.min < *known.low)
      say(at, known.section, fmt::format("begins at {}, LowLimit is {}", range.min, *known.low));
    if (known.high && range.max > *known.high)
      say(at, known.section, fmt::format("ends at {}, HighLimit is {}", range.max, *known.high));
  }

  void compare_value(const std::string& name, std::int64_t raw, const std::string& at) {
    const Object* object = profile_.find(name, 0);
    const Place* place = object == nullptr || object->is_part() ? nullptr : object->place(kCanopen);
    const EdsObject* known = place == nullptr ? nullptr : eds_.find(place->address);
    if (known == nullptr) return;  // told with the object, or not on canopen
    if ((known->low && raw < *known->low) || (known->high && raw > *known->high))
      say(at, known->section,
          fmt::format("{} is written, the limits are {} and {}", raw, limit_text(known->low), limit_text(known->high)));
  }

  void compare_setup(const JsonNode& write) {
    if (!is_on(write, kCanopen)) return;
    for (const WriteValue& value : values_in(profile_, write))
      if (const auto* raw = std::get_if<std::int64_t>(&value))
        compare_value(write.text("write"), *raw, write.pointer("value"));
  }

  void compare_tpdos(const model::CanopenProperties& canopen) {
    for (std::size_t i = 0; i < canopen.tpdos.size(); ++i) {
      const model::TpdoProperties& tpdo = canopen.tpdos[i];
      const std::string at = pointer_to("/protocols/canopen/tpdo", i);
      const auto parameters = static_cast<std::uint16_t>(kFirstTpdo + tpdo.number - 1);
      const auto mapping = static_cast<std::uint16_t>(kFirstMapping + tpdo.number - 1);
      for (const std::uint16_t index : {parameters, mapping})
        if (!eds_.has_index(index)) say(at, section_of({index, 0}), "the EDS has no such TPDO");
      const auto needs = [&](std::uint8_t sub, const char* key) {
        if (eds_.has_index(parameters) && eds_.find({parameters, sub}) == nullptr)
          say(pointer_to(at, key), section_of({parameters, sub}), "the EDS has no such sub-index");
      };
      if (tpdo.inhibit) needs(kInhibit, "inhibit_us");
      if (tpdo.event_ms) needs(kEventTimer, "event_ms");
      for (std::size_t k = 0; k < tpdo.map.size(); ++k)
        compare_mapped(profile_.objects[tpdo.map[k]], pointer_to(pointer_to(at, "map"), k));
    }
  }

  void compare_mapped(const Object& object, const std::string& at) {
    const Place* place = object.place(kCanopen);
    const EdsObject* known = place == nullptr ? nullptr : eds_.find(place->address);
    if (known == nullptr) return;  // told with the object
    if (!known->mappable) return say(at, known->section, "is mapped here, PDOMapping is 0 in the EDS");
    if (known->access == "rww") say(at, known->section, "is mapped to a TPDO here, rww (RPDO only) in the EDS");
  }

  const Profile& profile_;
  const Eds& eds_;
  std::vector<EdsContradiction> out_;
};

}  // namespace

std::vector<EdsContradiction> contradictions(const Profile& profile, const Eds& eds) {
  return Comparison(profile, eds).run();
}

}  // namespace axisgate::profile
