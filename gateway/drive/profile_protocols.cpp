// Section "protocols", "keepalive", and what of them only makes sense once objects are known.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/drive/profile_reading.hpp"

namespace axisgate::drive {

using nlohmann::json;

namespace {

constexpr std::int64_t kDefaultTimeoutMs = 100;

Duration milliseconds(std::int64_t count) { return std::chrono::milliseconds(count); }

void read_requests(Reading& reading, const json& node, const std::string& pointer, ProtocolSpec& out) {
  for (const char* section : {"requests", "unsolicited"}) {
    const json* frames = member(node, section);
    if (frames == nullptr || !frames->is_object()) continue;
    for (const auto& [name, frame] : frames->items()) {
      if (std::find(out.requests.begin(), out.requests.end(), name) != out.requests.end())
        reading.fault(pointer_to(pointer_to(pointer, section), name), "a request has this name already");
      out.requests.push_back(name);
    }
  }
  const json* requests = member(node, "requests");
  if (requests == nullptr || !requests->is_object()) return;
  for (const auto& [name, frame] : requests->items()) {
    const std::string confirm = text_in(frame, "confirm");
    const std::string at = pointer_to(pointer_to(pointer, "requests"), name);
    if (!confirm.empty() && member(*requests, confirm) == nullptr)
      reading.fault(pointer_to(at, "confirm"), "unknown request \"" + confirm + "\"" + hint(confirm, out.requests));
    if (text_in(frame, "ack") == "none" && confirm.empty())
      reading.fault(at, "a request without an answer needs \"confirm\": what else would decide its outcome?");
  }
}

void check_mapping(Reading& reading, const json& node, const std::string& pointer) {
  const json* pdos = member(node, "tpdo");
  if (pdos == nullptr || !pdos->is_array()) return;
  std::set<std::int64_t> numbers;
  for (std::size_t i = 0; i < pdos->size(); ++i) {
    const std::string at = pointer_to(pointer_to(pointer, "tpdo"), i);
    if (!numbers.insert(whole_in((*pdos)[i], "n", 0)).second) reading.fault(at, "this TPDO is given twice");
    std::size_t bytes = 0;
    for (const std::string& name : names_in((*pdos)[i], "map")) {
      const auto same = [&](const Object& object) { return object.name == name; };
      const auto object = std::find_if(reading.profile.objects.begin(), reading.profile.objects.end(), same);
      if (object == reading.profile.objects.end()) {
        reading.fault(pointer_to(at, "map"), "unknown object \"" + name + "\": not under /objects");
        continue;
      }
      bytes += object->type.size;
      if (!object->places.contains("canopen"))
        reading.fault(pointer_to(at, "map"), "object \"" + name + "\" has no address on canopen");
    }
    if (bytes > 8) reading.fault(pointer_to(at, "map"), "maps " + std::to_string(bytes) + " bytes; a PDO holds 8");
  }
}

/// What must be written to have the drive stop by itself.
void check_loss(Reading& reading, const std::string& protocol, const json& node, const std::string& pointer) {
  const json* loss = member(node, "loss");
  if (loss == nullptr || member(*loss, "object") == nullptr) return;
  const std::string name = text_in(*loss, "object");
  const std::string at = pointer_to(pointer_to(pointer, "loss"), "object");
  if (!reading.names_object(name, at)) return;
  reading.each_meaning(name, [&](const Object& object) {
    if (!object.places.contains(protocol))
      reading.fault(at, "object \"" + object.name + "\" has no address on " + protocol);
    if (!object.writable) reading.fault(at, "object \"" + object.name + "\" is read-only");
  });
}

void check_keepalive(Reading& reading) {
  const json* keepalive = member(reading.document, "keepalive");
  if (keepalive == nullptr) return;
  for (const std::string& protocol : names_in(*keepalive, "on"))
    if (!reading.profile.protocols.contains(protocol))
      reading.fault("/keepalive/on", "protocol \"" + protocol + "\" is not under /protocols" +
                                         hint(protocol, keys_in(reading.profile.protocols)));
}

}  // namespace

void read_protocols(Reading& reading) {
  const json* section = member(reading.document, "protocols");
  if (section == nullptr || !section->is_object()) return;
  for (const auto& [name, node] : section->items()) {
    ProtocolSpec out;
    out.timeout = milliseconds(whole_in(node, "timeout_ms", kDefaultTimeoutMs));
    out.worst_reply = milliseconds(whole_in(node, "worst_reply_ms", 0));
    const json* loss = member(node, "loss");
    out.stops_by_itself = loss != nullptr && !loss->is_null();
    if (const json* fence = member(node, "fence"); fence != nullptr && fence->is_array())
      for (const json& entry : *fence)
        out.fence.push_back(entry.is_string() ? entry.get<std::string>() : text_in(entry, "object"));
    const std::string pointer = pointer_to("/protocols", name);
    read_requests(reading, node, pointer, out);
    if (out.worst_reply < out.timeout)
      reading.fault(pointer_to(pointer, "worst_reply_ms"),
                    "must be at least timeout_ms: it is how long a lost reply may still come");
    reading.profile.protocols.emplace(name, std::move(out));
  }
}

void check_protocols(Reading& reading) {
  check_keepalive(reading);
  const json* section = member(reading.document, "protocols");
  for (const auto& [name, protocol] : reading.profile.protocols) {
    const std::string pointer = pointer_to("/protocols", name);
    if (section != nullptr && member(*section, name) != nullptr) {
      check_mapping(reading, *member(*section, name), pointer);
      check_loss(reading, name, *member(*section, name), pointer);
    }
    std::set<bus::ObjectAddress> addresses;
    for (std::size_t i = 0; i < protocol.fence.size(); ++i) {
      const std::string at = pointer_to(pointer_to(pointer, "fence"), i);
      const std::string& wanted = protocol.fence[i];
      // A fence may also be one of the protocol's own requests (Keya's queries).
      if (std::find(protocol.requests.begin(), protocol.requests.end(), wanted) != protocol.requests.end()) continue;
      if (!reading.names_object(wanted, at)) continue;
      const Object& object = *reading.profile.find(wanted, 0);
      const auto place = object.places.find(name);
      if (place == object.places.end())
        reading.fault(at, "object \"" + wanted + "\" has no address on " + name);
      else if (!object.readable)
        reading.fault(at, "object \"" + wanted + "\" cannot be read, so it is no fence");
      else if (name != "modbus-rtu" && place->second.request.empty() && !addresses.insert(place->second.address).second)
        reading.fault(at, "the same address stands in this fence already");
    }
  }
}

}  // namespace axisgate::drive
