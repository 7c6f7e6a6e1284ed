// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/session/device_identification.hpp"

#include <algorithm>

#include "gateway/image/register_map.hpp"

namespace axisgate::modbus_tcp {
namespace {

constexpr std::uint8_t kIndividual = 4;
constexpr std::uint8_t kMore = 0xFF;
constexpr std::size_t kLongestObject = 245;  // one object must fit one answer
constexpr std::size_t kHead =
    7;  // function, MEI type, code, conformity, more follows, next object id, number of objects

std::uint8_t last_of_level(std::uint8_t code) {
  if (code == 1) return 0x02;
  return code == 2 ? 0x7F : 0xFF;
}

void append(Pdu& pdu, const IdentificationObject& object) {
  pdu.push_back(object.id);
  pdu.push_back(static_cast<Byte>(object.value.size()));
  pdu.insert(pdu.end(), object.value.begin(), object.value.end());
  ++pdu[kHead - 1];
}

void append_names(std::vector<IdentificationObject>& objects, const ProcessImage& image) {
  IdentificationObject names{kNamesObject, {}};
  for (const auto& axis : image.axes()) {
    const std::string line = std::to_string(axis->number) + " " + axis->name + "\n";
    if (line.size() > kLongestObject) continue;
    if (names.value.size() + line.size() > kLongestObject) {
      objects.push_back(names);
      if (names.id == kLastNamesObject) return;
      names = {static_cast<std::uint8_t>(names.id + 1), {}};
    }
    names.value += line;
  }
  objects.push_back(std::move(names));
}

}  // namespace

std::vector<IdentificationObject> identification_objects(const ProcessImage& image, const ListenerSettings& settings) {
  std::vector<IdentificationObject> objects{
      {0x00, "axisgate"},
      {0x01, "axisgate"},
      {0x02, AXISGATE_VERSION},
      // 0x03, vendor URL: there is none.
      {0x04, "axisgate motor drive gateway"},
      {0x05, "unified axis map " + std::to_string(kMapVersion)},
      {0x06, "Modbus-TCP"},
      {kAxisCountObject, std::to_string(image.axes().size())},
      {kMapVersionObject, std::to_string(kMapVersion)},
      {kWordOrderObject, settings.low_word_first ? "low-first" : "high-first"},
      {kUnitIdsObject, settings.per_axis_units ? "per-axis" : "flat"},
      {kNumbersObject, settings.float_numbers ? "float" : "integer"},
      {kHalvesObject, settings.staged_halves ? "staged" : "refused"},
  };
  append_names(objects, image);
  return objects;
}

Pdu answer_identification(const Request& request, const std::vector<IdentificationObject>& objects) {
  const auto function = static_cast<Byte>(request.function);
  const auto asked =
      std::ranges::find_if(objects, [&](const IdentificationObject& each) { return each.id == request.object; });
  Pdu pdu{function, kDeviceIdentification, request.identification, kConformity, 0, 0, 0};
  if (request.identification == kIndividual) {
    if (asked == objects.end()) return exception_pdu(function, ModbusException::illegal_data_address);
    append(pdu, *asked);
    return pdu;
  }
  const std::uint8_t last = last_of_level(request.identification);
  const bool within = asked != objects.end() && asked->id <= last;
  for (auto each = within ? asked : objects.begin(); each != objects.end() && each->id <= last; ++each) {
    if (pdu.size() + 2 + each->value.size() > kMaxPdu) {
      pdu[4] = kMore;
      pdu[5] = each->id;
      break;
    }
    append(pdu, *each);
  }
  return pdu;
}

}  // namespace axisgate::modbus_tcp
