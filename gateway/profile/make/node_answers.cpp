// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/node_answers.hpp"

#include <fmt/format.h>

#include <array>

#include "gateway/profile/make/eds_objects.hpp"

namespace axisgate::profile {
namespace {

constexpr std::uint16_t kIdentity = 0x1018;
constexpr std::array kAsked = std::to_array<ObjectAddress>({{kIdentity, 1},
                                                            {kIdentity, 2},
                                                            {kIdentity, 3},
                                                            {0x6502, 0},
                                                            {0x608F, 1},
                                                            {0x608F, 2},
                                                            {0x6091, 1},
                                                            {0x6091, 2},
                                                            {0x6092, 1},
                                                            {0x6092, 2},
                                                            {0x60A8, 0},
                                                            {0x60A9, 0},
                                                            {0x60AA, 0}});

}  // namespace

std::vector<ObjectAddress> asked_of_node(const Eds& eds) {
  std::vector<ObjectAddress> out;
  for (const ObjectAddress address : kAsked) {
    const EdsObject* const object = eds.find(address);
    if (object != nullptr && eds_reads(*object) && why_not_usable(*object).empty()) out.push_back(address);
  }
  return out;
}

std::string take_answer(Eds& eds, const NodeAnswer& answer, std::uint8_t node) {
  const std::string at = address_text(answer.address);
  if (!answer.raw) {
    eds.objects.erase(answer.address);
    return fmt::format("{} is refused by node {}: taken for missing", at, node);
  }
  if (const auto known = eds.objects.find(answer.address); known != eds.objects.end())
    known->second.value = *answer.raw;
  if (answer.address.index == kIdentity)
    (answer.address.sub == 1 ? eds.vendor : answer.address.sub == 2 ? eds.product : eds.revision) = *answer.raw;
  return fmt::format("{} is {:#x}, read from node {}", at, *answer.raw, node);
}

}  // namespace axisgate::profile
