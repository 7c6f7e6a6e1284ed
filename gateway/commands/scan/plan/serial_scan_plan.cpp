// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/scan/plan/serial_scan_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "adapters/kinco/kinco_exchange.hpp"
#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "gateway/commands/scan/plan/drive_to_paste.hpp"
#include "gateway/config/adapter_names.hpp"
#include "gateway/core/rtu_crc.hpp"

namespace axisgate::commands {
namespace {

/// Kinco's protocol: the end of such a read and the head of any that follows are, to a drive that counts from its
/// second byte on, a write to another station. No read could be sent behind it.
bool closes_the_line(const ObjectAddress& address, const std::string& protocol) {
  const auto command = static_cast<kinco::Command>(address.index >> 8);
  return protocol == config::adapter::kKincoSerial && kinco::is_request(command) && command != kinco::Command::read;
}

/// Where a profile's object is read on this protocol; null: it is not, or a read of it is not documented to be
/// harmless.
const profile::Place* read_place(const profile::Object& object, const std::string& protocol) {
  const profile::Place* place =
      object.readable && !object.trigger && !object.is_part() ? object.place(protocol) : nullptr;
  return place == nullptr || closes_the_line(place->address, protocol) ? nullptr : place;
}

/// As they leave on the line.
std::vector<Byte> bytes_of(const std::string& protocol, const bus::Exchange& exchange) {
  if (protocol == config::adapter::kKincoSerial) {
    const kinco::FrameBytes frame = kinco::encode(kinco::request_of(exchange));
    return {frame.begin(), frame.end()};
  }
  const modbus_rtu::Frame frame = modbus_rtu::request_of(exchange, {});
  std::vector<Byte> out(frame.begin(), frame.end());
  const std::uint16_t crc = crc16(out);
  out.push_back(static_cast<Byte>(crc & 0xFF));
  out.push_back(static_cast<Byte>(crc >> 8));
  return out;
}

template <typename List>
bool has_address(const List& list, const ObjectAddress& address) {
  return std::ranges::any_of(list, [&](const auto& one) { return one.address == address; });
}

}  // namespace

SerialScanPlan::Protocol SerialScanPlan::protocol_of(const std::string& name,
                                                     const std::vector<profile::Profile>& profiles,
                                                     const ScanRange& stations) {
  Protocol out;
  out.name = name;
  const std::uint8_t last = name == config::adapter::kKincoSerial ? kLastKincoStation : kLastRtuStation;
  out.last_station = std::min(last, stations.last);
  for (const profile::Profile& profile : profiles) {
    if (!profile.protocols.contains(name)) continue;
    out.profiles.push_back(profile);
    for (const profile::Object& object : profile.objects) {
      const profile::Place* place = read_place(object, name);
      if (place != nullptr && out.objects.size() < kMostTried && !has_address(out.objects, place->address))
        out.objects.push_back({place->address, place->size, false});
    }
  }
  out.knocks = knocks_for(out.profiles, out.objects, name);
  return out;
}

/// As few objects as there can be of which every profile has one: each next one is what most of the others have.
std::vector<ObjectAddress> SerialScanPlan::knocks_for(const std::vector<profile::Profile>& profiles,
                                                      const std::vector<Tried>& objects, const std::string& protocol) {
  std::vector<ObjectAddress> out;
  std::vector<const profile::Profile*> left;
  for (const profile::Profile& profile : profiles) left.push_back(&profile);
  const auto has = [&](const profile::Profile& profile, const ObjectAddress& address) {
    return std::ranges::any_of(profile.objects, [&](const profile::Object& object) {
      const profile::Place* place = read_place(object, protocol);
      return place != nullptr && place->address == address;
    });
  };
  while (!left.empty()) {
    std::ptrdiff_t most = 0;
    ObjectAddress best;
    for (const Tried& object : objects) {
      const auto count =
          std::ranges::count_if(left, [&](const profile::Profile* profile) { return has(*profile, object.address); });
      if (count <= most) continue;
      most = count;
      best = object.address;
    }
    if (most == 0) break;
    out.push_back(best);
    std::erase_if(left, [&](const profile::Profile* profile) { return has(*profile, best); });
  }
  return out;
}

SerialScanPlan::SerialScanPlan(const std::vector<profile::Profile>& profiles, const SerialScanSettings& settings)
    : bauds_(settings.bauds), stations_(settings.stations) {
  for (const std::string& name : settings.protocols) {
    Protocol protocol = protocol_of(name, profiles, stations_);
    const int stations = protocol.last_station - stations_.first + 1;
    if (protocol.knocks.empty() || stations <= 0) continue;
    knocks_ += static_cast<int>(bauds_.size() * protocol.knocks.size()) * stations;
    protocols_.push_back(std::move(protocol));
  }
  station_ = stations_.first;
  over_ = protocols_.empty() || bauds_.empty();
  choose();
}

std::optional<SerialSpeech> SerialScanPlan::speech() const {
  if (over_) return std::nullopt;
  return SerialSpeech{protocol().name, bauds_[baud_]};
}

std::optional<bus::Exchange> SerialScanPlan::next() const { return over_ ? std::nullopt : chosen_; }

void SerialScanPlan::choose() {
  constexpr std::array<std::uint8_t, 2> kKnockSizes{2, 4};
  while (!over_) {
    bus::Exchange read;
    read.node = static_cast<std::uint8_t>(station_);
    read.object = reading_ ? tried_[object_].address : protocol().knocks[knock_];
    for (const std::uint8_t size : kKnockSizes) {
      read.size = reading_ ? tried_[object_].size : size;
      if (!is_safe(read)) continue;
      chosen_ = read;
      return;
    }
    if (reading_) {
      if (++object_ == tried_.size()) end_station();
    } else {
      ++knocked_;
      next_knock();
    }
  }
}

bool SerialScanPlan::is_safe(const bus::Exchange& exchange) const {
  std::vector<Byte> line = sent_;
  const std::vector<Byte> frame = bytes_of(protocol().name, exchange);
  line.insert(line.end(), frame.begin(), frame.end());
  for (std::size_t at = 0; at + kinco::kFrameSize <= line.size(); ++at) {
    const auto heard = kinco::decode(Bytes(line).subspan(at, kinco::kFrameSize));
    const auto* one = std::get_if<kinco::Frame>(&heard);
    if (one != nullptr && kinco::is_request(one->command) && one->command != kinco::Command::read) return false;
  }
  return true;
}

void SerialScanPlan::note_sent() {
  const std::vector<Byte> frame = bytes_of(protocol().name, *chosen_);
  sent_.insert(sent_.end(), frame.begin(), frame.end());
  const auto more = static_cast<std::ptrdiff_t>(sent_.size()) - static_cast<std::ptrdiff_t>(kinco::kFrameSize - 1);
  if (more > 0) sent_.erase(sent_.begin(), sent_.begin() + more);
}

void SerialScanPlan::on_result(const bus::ExchangeResult& result) {
  if (over_) return;
  note_sent();
  take(result);
  choose();
}

void SerialScanPlan::take(const bus::ExchangeResult& result) {
  // Whatever came, somebody is there; a refusal and a bad reply are answers too.
  const bool silent =
      result.code != Errc::ok && result.code != Errc::refused_by_drive && result.code != Errc::bad_reply;
  if (!reading_) {
    ++knocked_;
    if (silent) return next_knock();
    current_ = {*speech(), static_cast<std::uint8_t>(station_), false, {}};
    tried_ = protocol().objects;
    reading_ = true;
    object_ = 0;
    silences_ = 0;
    return;
  }
  silences_ = silent ? silences_ + 1 : 0;
  if (silences_ >= kSilences) {
    current_.fell_silent = true;
    return end_station();
  }
  tried_[object_].has = result.code == Errc::ok && !result.fields.empty();
  if (++object_ == tried_.size()) end_station();
}

void SerialScanPlan::end_station() {
  current_.fits = fits();
  found_.push_back(current_);
  reading_ = false;
  // The knocks that its answer has saved.
  knocked_ += static_cast<int>(protocol().knocks.size() - knock_) - 1;
  next_station();
}

void SerialScanPlan::next_knock() {
  if (++knock_ == protocol().knocks.size()) next_station();
}

void SerialScanPlan::next_station() {
  knock_ = 0;
  if (++station_ > protocol().last_station) next_speech();
}

/// All protocols at one rate, then the next rate: a line has one rate more often than one protocol.
void SerialScanPlan::next_speech() {
  station_ = stations_.first;
  if (++protocol_ < protocols_.size()) return;
  protocol_ = 0;
  sent_.clear();  // at another rate those were no bytes
  over_ = ++baud_ == bauds_.size();
}

std::vector<ScanFit> SerialScanPlan::fits() const {
  std::vector<ScanFit> out;
  for (const profile::Profile& profile : protocol().profiles) {
    ScanFit fit{profile.name};
    fit.only_simulated = profile.only_simulated;
    fit.wanted = profile.wanted(protocol().name, {});
    for (const profile::Object& object : profile.objects) {
      const profile::Place* place = read_place(object, protocol().name);
      if (place == nullptr) continue;
      const auto tried = std::ranges::find_if(tried_, [&](const Tried& one) { return one.address == place->address; });
      if (tried == tried_.end()) continue;
      ++fit.of;
      if (tried->has) ++fit.has;
    }
    if (fit.of > 0 && 2 * fit.has >= fit.of) out.push_back(std::move(fit));
  }
  std::ranges::stable_sort(out, better_fit);
  return out;
}

Duration longest_silence(const SerialScanPlan& plan, Duration timeout) { return plan.knocks() * timeout; }

std::string serial_scan_table(const std::vector<FoundStation>& found, const std::string& device) {
  if (found.empty()) return {};
  std::string out = fmt::format("{:<12}  {:>6}  {:>7}  {}\n", "protocol", "baud", "station", "profile");
  std::string remarks;
  std::vector<SerialSpeech> speeches;
  for (const FoundStation& station : found) {
    std::vector<std::string> fits;
    for (const ScanFit& fit : station.fits)
      fits.push_back(fmt::format("{} ({} of {} objects)", fit.profile, fit.has, fit.of));
    out += fmt::format("{:<12}  {:>6}  {:>7}  {}\n", station.speech.protocol, station.speech.baud, station.station,
                       fits.empty() ? "none fits" : fits.front());
    if (station.fell_silent)
      remarks +=
          fmt::format("station {}: it fell silent while it was asked: what follows its last answer is not known\n",
                      station.station);
    if (fits.size() > 1 && station.fits[0].has < station.fits[0].of) {
      fits.erase(fits.begin());
      remarks += fmt::format("station {}: {} fits best; less: {}\n", station.station, station.fits[0].profile,
                             fmt::join(fits, ", "));
    }
    if (!station.fits.empty() && station.fits[0].only_simulated)
      remarks += fmt::format("station {}: {}: {}\n", station.station, station.fits[0].profile, model::kOnlySimulated);
    const bool known = std::ranges::find(speeches, station.speech) != speeches.end();
    if (!known && !station.fits.empty()) speeches.push_back(station.speech);
  }
  if (!remarks.empty()) out += "\n" + remarks;
  for (const SerialSpeech& speech : speeches) {
    std::vector<std::string> drives;
    for (const FoundStation& station : found)
      if (station.speech == speech && !station.fits.empty())
        drives.push_back(drive_to_paste(station.fits.front(), station.station, {}, "    "));
    out += fmt::format(
        "\na bus of a configuration (its name and the axis numbers are yours to choose{}):\n"
        "  {{\"name\": \"line\", \"adapter\": \"{}\", \"device\": \"{}\", \"baud\": {}, \"drives\": [\n{}]}}\n",
        to_fill_in(drives), speech.protocol, device, speech.baud, fmt::join(drives, ",\n"));
  }
  return out;
}

}  // namespace axisgate::commands
