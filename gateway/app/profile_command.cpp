#include "gateway/app/profile_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "gateway/app/faults_told.hpp"
#include "gateway/drive/profile_loader.hpp"

namespace axisgate::app {
namespace {

using drive::Profile;

bool has_place(const Profile& profile, const std::string& object, std::string_view protocol) {
  for (std::size_t slot = 0; slot < profile.axes.size(); ++slot) {
    const drive::Object* found = profile.find(object, static_cast<bus::AxisSlot>(slot));
    if (found != nullptr && found->places.contains(protocol)) return true;
  }
  return false;
}

/// Some object gives it on this protocol. What constants decide (torque in percent needs a rated current) is `axisgate
/// check`'s to say: it knows the configured drive.
bool given(const Profile& profile, const QuantityRow& row, std::string_view protocol) {
  if (row.quantity == Quantity::error_code) return !profile.alarms.empty();  // made from the alarm table
  constexpr std::array kMade{Quantity::statusword, Quantity::mode_display, Quantity::controlword, Quantity::mode};
  if (profile.state.is_virtual && std::find(kMade.begin(), kMade.end(), row.quantity) != kMade.end()) return true;
  const drive::QuantitySpec* quantity = profile.find(row.quantity);
  if (quantity == nullptr) return false;
  const auto place = [&](const std::string& object) { return has_place(profile, object, protocol); };
  return std::any_of(quantity->objects.begin(), quantity->objects.end(), place) ||
         std::any_of(quantity->bits.begin(), quantity->bits.end(),
                     [&](const drive::BitsSpec& bits) { return place(bits.object); });
}

void print_protocol(const Profile& profile, const std::string& protocol, const drive::ProtocolSpec& facts) {
  std::vector<std::string_view> missing;
  std::size_t count = 0;
  for (const QuantityRow& quantity : quantity_table()) {
    if (given(profile, quantity, protocol)) {
      ++count;
    } else {
      missing.push_back(quantity.name);
    }
  }
  const auto objects = std::count_if(profile.objects.begin(), profile.objects.end(),
                                     [&](const drive::Object& object) { return object.places.contains(protocol); });
  fmt::print("  {:<14}{} objects, {} of {} quantities; {}\n", protocol, objects, count, kQuantityCount,
             facts.stops_by_itself ? "stops by itself when the gateway dies"
                                   : "does not stop by itself when the gateway dies");
  if (!missing.empty()) fmt::print("  {:<14}without {}\n", "", fmt::join(missing, ", "));
}

}  // namespace

int run(const ProfileCheckOptions& options) {
  const drive::LoadedProfile loaded = drive::load_profile(options.file);
  std::vector<ConfigFault> faults;
  for (const drive::Fault& fault : loaded.faults)
    faults.push_back(ConfigFault{fault.file, fault.pointer, fault.message});
  if (!faults.empty()) return tell(faults);

  const Profile& profile = loaded.profile;
  fmt::print("{} is valid: {}, {} motor{}, {} alarms, {} checks\n", options.file, profile.title, profile.axes.size(),
             profile.axes.size() == 1 ? "" : "s", profile.alarms.size(), profile.checks.size());
  for (const auto& [protocol, facts] : profile.protocols) print_protocol(profile, protocol, facts);
  return 0;
}

}  // namespace axisgate::app
