// SPDX-License-Identifier: Apache-2.0
// What people write: profiles, configurations and EDS files. Each mistake is told, and none is a crash.
#include <sys/mman.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "gateway/config/config_loader.hpp"
#include "gateway/profile/eds/eds.hpp"
#include "gateway/profile/eds/eds_compare.hpp"
#include "gateway/profile/make/from_form.hpp"
#include "gateway/profile/read/profile_loader.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/places.hpp"

namespace axisgate::fuzz {
namespace {

const std::string kShippedProfiles = test::source_path("schemas/drives");

/// A file in memory alone, with a path.
class MemoryFile {
 public:
  explicit MemoryFile(Bytes content) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    must(descriptor_ >= 0, "a file in memory can be made");
    must(::write(descriptor_, content.data(), content.size()) == static_cast<ssize_t>(content.size()),
         "and takes its content");
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(descriptor_); }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void profile(Bytes content) {
  const MemoryFile file(content);
  const profile::LoadedProfile loaded = profile::load_profile(file.path(), {kShippedProfiles});
  for (const profile::Fault& fault : loaded.faults) must(!fault.message.empty(), "a mistake has its words");
}

void configuration(Bytes content) {
  const MemoryFile file(content);
  const config::LoadResult loaded = config::load_config(file.path(), {kShippedProfiles});
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&loaded)) {
    must(!faults->empty(), "what is refused has its reason");
    for (const config::ConfigFault& fault : *faults) must(!config::text(fault).empty(), "a mistake has its words");
  } else {
    const auto& good = std::get<config::LoadedConfig>(loaded);
    must(good.models.size() == good.config.buses.size(), "each bus has the models of its drives");
  }
}

void is_a_document(const profile::MadeProfile& made) {
  must(made.text.empty() != made.faults.empty(), "a profile is made, or it is told why not");
  if (made.text.empty()) return;
  must(std::holds_alternative<nlohmann::json>(profile::parse_json(made.text)), "what is made is JSON");
}

void makes_a_document(const profile::Eds& sheet) {
  static const profile::LayeredProfile kBase =
      profile::layered_profile(kShippedProfiles + "/cia402-generic.json", {kShippedProfiles});
  is_a_document(profile::profile_from_eds(sheet, *kBase.document, {"made", "cia402-generic", "drive.eds"}));
}

void eds(Bytes content) {
  const profile::Eds sheet = profile::parse_eds({reinterpret_cast<const char*>(content.data()), content.size()});
  must(sheet.objects.size() <= profile::kMaxEdsObjects, "objects have their bound");
  must(sheet.remarks.size() <= profile::kMaxEdsRemarks, "remarks have their bound");
  static const profile::LoadedProfile kProfile =
      profile::load_profile(kShippedProfiles + "/leadshine-ld2-can.json", {kShippedProfiles});
  for (const auto& each : profile::contradictions(kProfile.profile, sheet))
    must(!each.message.empty(), "a contradiction has its words");
  makes_a_document(sheet);
}

/// As a table of registers, whatever it is.
void form(Bytes content) {
  const std::string_view text{reinterpret_cast<const char*>(content.data()), content.size()};
  for (const profile::FormOf what : {profile::FormOf::modbus, profile::FormOf::canopen}) {
    const profile::Form form = profile::parse_form(text, what);
    must(!form.faults.empty() || !form.rows.empty(), "a table is one, or it is told why not");
    if (form.faults.empty()) is_a_document(profile::profile_from_form(form, {"made", "", "table.csv"}));
  }
}

}  // namespace
}  // namespace axisgate::fuzz

int axisgate_fuzz_profile(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::profile({data, size});
  return 0;
}
int axisgate_fuzz_configuration(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::configuration({data, size});
  return 0;
}
int axisgate_fuzz_eds(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::eds({data, size});
  axisgate::fuzz::form({data, size});
  return 0;
}
