// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/simulated/bench.hpp"

#include <algorithm>

#include "tests/axisgate_sim/spec_words.hpp"

namespace axisgate::simulated {
Bytes from_hex(std::string_view text) {
  std::string digits(text);
  std::erase(digits, ' ');
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

std::string to_hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += {"0123456789ABCDEF"[byte >> 4], "0123456789ABCDEF"[byte & 15]};
  return text;
}

Bytes part(std::span<const std::uint8_t> bytes, std::size_t from, std::size_t to) {
  const auto piece = bytes.subspan(from, to - from);
  return {piece.begin(), piece.end()};
}

LineTimings untimed() {
  LineTimings timings;
  timings.rtu.baud = 0;
  timings.rtu.reply_delay = Time{};
  timings.can.bit_rate = 0;
  timings.can.reply_delay = Time{};
  return timings;
}

LineSpec spec_of(std::string text) {
  const bool stops = text.ends_with("~stops");
  std::string drives;
  for (std::string_view drive : split(std::string_view(text).substr(0, text.find('~')), ',')) {
    const std::size_t end = std::min(drive.find('+'), drive.size());
    const bool numbered = drive.substr(0, end).find('@') != std::string_view::npos;
    drives += (drives.empty() ? "" : ",") + std::string(drive.substr(0, end)) + (numbered ? "" : "@1");
    drives += drive.substr(end);
  }
  LineSpec spec = parse_line_spec("line:" + drives, {});
  if (stops) {
    spec.drives.at(0).mechanics.negative_stop = -60000;
    spec.drives.at(0).mechanics.positive_stop = 60000;
    spec.drives.at(0).mechanics.index_offset = 2000;
  }
  return spec;
}

Bench::Bench(const LineSpec& spec, const LineTimings& timings, std::uint64_t seed) {
  const auto keep = [this](const ToHost& it) {
    arrivals.push_back({it.at, it.tag, it.origin, {it.bytes.begin(), it.bytes.end()}});
  };
  const auto fill = [this](auto made, auto& on, const auto& drives) {
    on = made.get();
    port.line = std::move(made);
    if constexpr (requires { on->bus(); }) {
      for (const auto& drive : drives) on->bus().add(drive);
    } else {
      for (const auto& drive : drives) on->add(drive);
    }
  };
  port.spec = spec;
  if (spec.kind == LineKind::lawicel) {
    fill(std::make_unique<LawicelLine>(timings.can, LawicelOptions{}, Random(seed), keep), port.can, spec.can_drives);
  } else if (spec.is_can()) {
    fill(std::make_unique<SocketCanLine>(timings.can, Random(seed), keep), port.can, spec.can_drives);
  } else if (spec.kind == LineKind::rtu) {
    fill(std::make_unique<RtuLine>(timings.rtu, Random(seed), keep), port.rtu, spec.rtu_drives);
  } else if (spec.is_keya_serial()) {
    KeyaLineOptions options = timings.keya;
    options.wiring = spec.kind == LineKind::keya_rs232 ? KeyaWiring::rs232 : KeyaWiring::rs485;
    fill(std::make_unique<KeyaLine>(options, Random(seed), keep), port.keya, spec.keya_drives);
  } else {
    fill(std::make_unique<SerialLine>(timings.serial, Random(seed), keep), port.serial, spec.drives);
  }
}

Bytes Bench::exchange(std::span<const std::uint8_t> request) {
  arrivals.clear();
  line().from_host(request, now);
  return received();
}

Bytes Bench::sdo(const Bytes& request, std::uint8_t node) {
  arrivals.clear();
  send(bus_frame(cob::sdo_request + node, request));
  return heard(cob::sdo_reply + node);
}

Bytes Bench::keya_can(const Bytes& request) {
  BusFrame frame = bus_frame(keya_can::command + 1, request);
  frame.extended = true;
  arrivals.clear();
  send(frame);
  return heard(keya_can::reply + 1);
}

Bytes Bench::heard(std::uint32_t id) const {
  const auto all = frames();
  const auto found = std::find_if(all.rbegin(), all.rend(), [id](const BusFrame& it) { return it.id == id; });
  return found == all.rend() ? Bytes{} : Bytes{found->data.begin(), found->data.begin() + found->size};
}

std::string Bench::tell(ControlWords words) {
  static Simulator nowhere;
  words.insert(words.begin() + 1, "line/1");
  std::optional<std::string> told;
  if (port.can != nullptr) {
    told = ask_can(nowhere, port, 0, words);
  } else if (port.keya != nullptr) {
    told = ask_keya(*keya(), words, now);
  } else {
    told = kinco() != nullptr ? ask_kinco(*kinco(), words) : ask_id286pro(*id286pro(), words);
  }
  if (!told) throw std::invalid_argument("no such word: " + words[0]);
  return told->empty() ? "" : told->substr(1);
}

Bytes Bench::received() const {
  Bytes all;
  for (const Arrival& arrival : arrivals) all.insert(all.end(), arrival.bytes.begin(), arrival.bytes.end());
  return all;
}

std::vector<BusFrame> Bench::frames() const {
  std::vector<BusFrame> all;
  for (const Arrival& arrival : arrivals) {
    if (const auto frame = frame_of_socket(arrival.bytes)) all.push_back(*frame);
  }
  return all;
}

KincoDrive* Bench::kinco() {
  if (port.serial != nullptr) return &port.serial->drive(0);
  return port.rtu != nullptr ? port.rtu->kinco(0) : port.can != nullptr ? bus().kinco(0) : nullptr;
}

KeyaDrive* Bench::keya() {
  if (port.keya != nullptr) return &port.keya->drive(0);
  return port.can != nullptr ? bus().keya(0) : nullptr;
}

Bytes sdo_request(std::uint8_t command, ObjectKey key, std::uint32_t data) {
  Bytes bytes{command, static_cast<std::uint8_t>(key.index), static_cast<std::uint8_t>(key.index >> 8), key.sub};
  const CanBytes four = little_endian(data, 4);
  bytes.insert(bytes.end(), four.begin(), four.end());
  return bytes;
}

Bytes ten_bytes(FrameCommand command, ObjectKey key, std::uint32_t data, std::uint8_t station) {
  const TenByteFrame frame = seal(station, command, key.index, key.sub, data);
  return {frame.begin(), frame.end()};
}

}  // namespace axisgate::simulated
