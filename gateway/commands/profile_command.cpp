// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <variant>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/commands/profile/eds_file.hpp"
#include "gateway/profile/eds/eds_compare.hpp"
#include "gateway/profile/read/profile_loader.hpp"

namespace axisgate::commands {
namespace {

using profile::Profile;

bool has_place(const Profile& profile, const std::string& object, std::string_view protocol) {
  for (std::size_t slot = 0; slot < profile.axes.size(); ++slot) {
    const profile::Object* found = profile.find(object, static_cast<AxisSlot>(slot));
    if (found != nullptr && found->places.contains(protocol)) return true;
  }
  return false;
}

/// Some object gives it on this protocol. What constants decide (torque in percent needs a rated current) is `axisgate
/// check`'s to say: it knows the configured drive.
bool given(const Profile& profile, const QuantityRow& row, std::string_view protocol) {
  // Made from the alarm table, or from what the drive sends.
  if (row.quantity == Quantity::error_code) return !profile.alarms.empty() || profile.has_emergency_word(protocol);
  constexpr std::array kEmulated{Quantity::statusword, Quantity::mode_display, Quantity::controlword, Quantity::mode};
  if (profile.state.is_virtual && std::ranges::find(kEmulated, row.quantity) != kEmulated.end()) return true;
  const profile::QuantitySpec* quantity = profile.find(row.quantity);
  if (quantity == nullptr) return false;
  const auto place = [&](const std::string& object) { return has_place(profile, object, protocol); };
  return std::ranges::any_of(quantity->objects, place) ||
         std::ranges::any_of(quantity->bits, [&](const profile::BitsSpec& bits) { return place(bits.name); });
}

void print_protocol(const Profile& profile, const std::string& protocol, const profile::ProtocolSpec& facts) {
  std::vector<std::string_view> missing;
  std::size_t count = 0;
  for (const QuantityRow& quantity : quantity_table()) {
    if (given(profile, quantity, protocol)) {
      ++count;
    } else {
      missing.push_back(quantity.name);
    }
  }
  const auto objects = std::ranges::count_if(
      profile.objects, [&](const profile::Object& object) { return object.places.contains(protocol); });
  fmt::print("  {:<14}{} objects, {} of {} quantities; {}\n", protocol, objects, count, kQuantityCount,
             facts.stops_by_itself() ? "stops by itself when the gateway dies"
                                     : "does not stop by itself when the gateway dies");
  if (!missing.empty()) fmt::print("  {:<14}without {}\n", "", fmt::join(missing, ", "));
}

int compare(const ProfileCheckOptions& options, const profile::LoadedProfile& loaded) {
  const Profile& profile = loaded.profile;
  const auto read = load_eds(options.eds);
  if (const auto* wrong = std::get_if<std::vector<config::ConfigFault>>(&read)) return tell(*wrong);
  const auto& eds = std::get<profile::Eds>(read);
  if (!profile.protocols.contains("canopen"))
    return tell({{options.file, "/protocols", "has no canopen, and an EDS describes nothing else"}});
  fmt::print("  {:<14}{}: {}, {} objects\n", "EDS", options.eds, identity_text(eds), eds.objects.size());
  print_remarks(eds);
  std::vector<config::ConfigFault> faults;
  for (const profile::EdsContradiction& found : profile::contradictions(profile, eds)) {
    const profile::Written written = profile::written_at(loaded.written, found.pointer);
    faults.push_back({written.file, written.pointer,
                      fmt::format("{} [{}]: {}", options.eds, printable(found.section), printable(found.message))});
  }
  if (faults.empty()) fmt::print("  {:<14}nothing in it contradicts the profile\n", "");
  std::fflush(stdout);
  return tell(faults);
}

}  // namespace

int run(const ProfileCheckOptions& options) {
  const profile::LoadedProfile loaded = profile::load_profile(options.file, options.profile_folders);
  if (!loaded.faults.empty()) return tell(loaded.faults);

  const Profile& profile = loaded.profile;
  fmt::print("{} is valid: {}, {} motor{}, {} alarms, {} checks\n", options.file, profile.title, profile.axes.size(),
             profile.axes.size() == 1 ? "" : "s", profile.alarms.size(), profile.section("checks").elements().size());
  for (const auto& [protocol, facts] : profile.protocols) print_protocol(profile, protocol, facts);
  std::vector<std::string> shared;
  for (const AxisSlot motor : profile.shared()) shared.push_back(profile.axes[motor]);
  if (!shared.empty())
    fmt::print("  {:<14}motors {} are enabled, stopped and reset as one, and have one mode and one owner\n", "shared",
               fmt::join(shared, " and "));
  for (const profile::Ask& ask : profile.open_asks({}))
    fmt::print("  {:<14}{}: {}{}\n", "open", ask.of, ask.question(),
               ask.before.empty() ? "" : fmt::format("; before it is answered no {}", fmt::join(ask.before, ", no ")));
  return options.eds.empty() ? 0 : compare(options, loaded);
}

}  // namespace axisgate::commands
