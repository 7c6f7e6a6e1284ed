// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/from_eds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "gateway/profile/make/eds_objects.hpp"
#include "gateway/profile/make/eds_questions.hpp"
#include "gateway/profile/make/eds_traffic.hpp"
#include "gateway/profile/make/profile_text.hpp"
#include "gateway/profile/make/take_out.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

std::string hex(std::int64_t number) { return fmt::format("0x{:08X}", number); }

/// "identity", where the EDS names its maker.
void identify(const Eds& eds, json& wanted) {
  constexpr std::int64_t kLargest = 0xFFFFFFFF;
  const auto given = [](const std::optional<std::int64_t>& number) {
    return number && *number > 0 && *number <= kLargest;
  };
  if (!given(eds.vendor)) return;
  json identity = {{"vendor", hex(*eds.vendor)}};
  if (given(eds.product)) identity["product"] = {hex(*eds.product)};
  if (given(eds.product) && given(eds.revision)) identity["revision"] = {hex(*eds.revision)};
  wanted["identity"] = std::move(identity);
}

void entitle(const Eds& eds, const FromEds& what, json& wanted) {
  const std::string title = plain_text(eds.vendor_name + " " + eds.product_name);
  wanted["title"] = title.empty() ? what.name : title;
  const std::string version = eds.version.empty() ? "" : ", file version " + plain_text(eds.version, 20);
  wanted["source"] = fmt::format("EDS {}{}; what it does not say: \"ask\"", plain_text(what.file), version);
  wanted["tried"] = "simulated";
  wanted["nvm"] = "unknown";
}

/// The modes that 6502h has a bit of, where the EDS gives it a number.
void choose_modes(const Eds& eds, json& wanted, MadeProfile& out) {
  const EdsObject* supported = eds.find({0x6502, 0});
  if (supported != nullptr && supported->value.value_or(0) != 0) {
    std::vector<std::string> gone;
    for (const auto& [mode, value] : wanted["modes"].items()) {
      const auto number = eds_mode(mode);
      if (number && (*supported->value >> (*number - 1) & 1) == 0) gone.push_back(mode);
    }
    for (const std::string& mode : gone) take_out_mode(wanted, mode);
    if (!gone.empty())
      out.notes.push_back(fmt::format("modes without {}: 6502h is {:#x}", fmt::join(gone, ", "), *supported->value));
  }
  take_out_modes(wanted);
}

/// Without 603Fh the code comes by EMCY alone.
void take_codes_from_emcy(json& wanted) {
  if (!wanted["quantities"].contains("error_code")) wanted["alarms"]["words"] = {"emcy"};
}

/// What a cia402 profile is nothing without.
void require(const json& wanted, const Eds& eds, MadeProfile& out) {
  for (const auto& [quantity, index] :
       {std::pair{"controlword", 0x6040}, std::pair{"statusword", 0x6041}, std::pair{"mode", 0x6060}}) {
    if (wanted["quantities"].contains(quantity)) continue;
    out.faults.push_back(fmt::format("{:04X}h ({}): {}; no CiA 402 drive is commanded without it", index, quantity,
                                     why_missing(eds, {static_cast<std::uint16_t>(index), 0})));
  }
  for (const char* const command : {"enable", "disable", "quick_stop"})
    if (out.faults.empty() && !wanted["commands"].contains(command))
      out.faults.push_back(fmt::format("what {} needs is not in the EDS", command));
  if (out.faults.empty() && wanted["modes"].empty())
    out.faults.emplace_back(
        "no mode is left of position (1, 607Ah), velocity (3, 60FFh), torque (4, 6071h) and homing (6, 6098h)");
}

}  // namespace

MadeProfile profile_from_eds(const Eds& eds, const json& base, const FromEds& what) {
  MadeProfile out;
  json wanted = base;
  entitle(eds, what, wanted);
  identify(eds, wanted);
  fit_objects(eds, wanted, out.notes);
  choose_modes(eds, wanted, out);
  take_codes_from_emcy(wanted);
  fit_traffic(eds, wanted, out.notes);
  ask_questions(eds, wanted, out.questions);
  require(wanted, eds, out);
  constexpr std::uint16_t kNextAxis = 0x800;  // CiA 402-2: a device of several axes
  if (eds.has_index(0x6040 + kNextAxis))
    out.notes.emplace_back("6840h is in the EDS: there is a second axis, and this profile is of the first alone");
  if (!out.faults.empty()) return out;
  json inherited = base;
  for (const char* const key : {"$schema", "name", "base_only", "tried", "nvm"}) inherited.erase(key);
  for (const char* const key : {"$schema", "name", "base_only"}) wanted.erase(key);
  json made = difference(inherited, wanted);
  made["profile"] = base.value("profile", json(1));
  made["name"] = what.name;
  made["extends"] = what.base;
  out.text = profile_text(made);
  return out;
}

}  // namespace axisgate::profile
