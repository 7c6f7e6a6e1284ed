#include "gateway/app/commission_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::app {
namespace {

std::string address_of(const drive::ObjectDef& object) {
  return fmt::format("{} ({:04X}.{:02X})", object.name, object.address.index, object.address.sub);
}

}  // namespace

std::vector<Finding> findings(const drive::DriveModel& model, const drive::ObjectStore& store, bus::AxisSlot slot) {
  std::vector<Finding> out;
  for (const drive::Check& check : model.checks) {
    if (check.slot != bus::kNoAxis && check.slot != slot) continue;
    const drive::ObjectState& state = store[check.bad.object];
    const bool bad =
        state.known && check.bad.holds(model.object(check.bad.object), static_cast<std::uint32_t>(state.number));
    out.push_back({&check, state.known, bad, state.number});
  }
  return out;
}

std::vector<drive::ObjectWrite> remedies(const std::vector<Finding>& found) {
  std::vector<drive::ObjectWrite> out;
  for (const Finding& finding : found) {
    if (!finding.bad) continue;
    for (const drive::ObjectWrite& write : finding.check->remedy) {
      // The last occurrence counts: every remedy ends with storing, and storing once, at the end, is enough.
      std::erase_if(out, [&](const drive::ObjectWrite& w) { return w.object == write.object && w.raw == write.raw; });
      out.push_back(write);
    }
  }
  return out;
}

std::string text(const drive::DriveModel& model, const drive::ObjectWrite& write) {
  const std::string what = fmt::format("{} = {}", address_of(model.object(write.object)), write.raw);
  return write.why.empty() ? what : fmt::format("{}  {}", what, write.why);
}

std::string text(const drive::DriveModel& model, const Finding& finding) {
  const drive::Check& check = *finding.check;
  const std::string where = address_of(model.object(check.bad.object));
  if (!finding.known) return fmt::format("?    {}: {} is not known", check.name, where);
  if (!finding.bad) return fmt::format("ok   {}: {} = {:#x}", check.name, where, finding.value);
  return fmt::format("BAD  {}: {} = {:#x}\n       {}", check.name, where, finding.value, check.text);
}

}  // namespace axisgate::app
