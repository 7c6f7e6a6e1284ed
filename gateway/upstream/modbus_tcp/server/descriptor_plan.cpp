// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/server/descriptor_plan.hpp"

#include <algorithm>

namespace axisgate::modbus_tcp {

DescriptorPlan plan_descriptors(const DescriptorLimits& limits, const DescriptorNeeds& needs) {
  DescriptorPlan plan;
  plan.needs = needs;
  plan.soft_limit = std::max(limits.soft, std::min(limits.hard, needs.limit()));
  const std::uint64_t above = plan.soft_limit > kSelectLimit ? plan.soft_limit - kSelectLimit : 0;
  const std::uint64_t low = std::min(plan.soft_limit, kSelectLimit);
  const std::uint64_t below = low > needs.reserve() ? low - needs.reserve() : 0;
  // A limit just above 1024 may have more room below: what serves more clients is taken, but above where all fit.
  plan.move_up = above > 0 && (above >= needs.clients || above >= below);
  const std::uint64_t room = plan.move_up ? above : below;
  plan.max_clients = static_cast<std::uint32_t>(std::min<std::uint64_t>(needs.clients, room));
  return plan;
}

std::string text(const DescriptorPlan& plan) {
  if (!plan.limited()) return {};
  return "at most " + std::to_string(plan.max_clients) + " clients at once, though max_clients allows " +
         std::to_string(plan.needs.clients) + ": this process may have " + std::to_string(plan.soft_limit) +
         " files open, and descriptors below " + std::to_string(kSelectLimit) +
         " are kept for serial ports; raise its hard limit to " + std::to_string(plan.needs.limit()) +
         " (LimitNOFILE of a service, ulimit -Hn of a shell) or lower max_clients";
}

}  // namespace axisgate::modbus_tcp
