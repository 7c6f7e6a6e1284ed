#include <iomanip>
#include <sstream>

#include "tests/unit/simulated/scene_parts.hpp"

namespace axisgate::simulated {
namespace {

std::string text_of(const BusFrame& frame) {
  std::ostringstream text;
  text << std::hex << std::uppercase << std::setfill('0') << std::setw(frame.extended ? 8 : 3) << frame.id << '#';
  return text.str() + (frame.remote ? "R" : to_hex(bytes_of(frame)));
}

BusFrame frame_in(const std::string& text) {
  const std::size_t mark = text.find('#');
  const auto id = static_cast<std::uint32_t>(std::stoul(text.substr(0, mark), nullptr, 16));
  const std::string data = text.substr(mark + 1);
  BusFrame frame = data == "R" ? bus_remote_frame(id) : bus_frame(id, from_hex(data));
  frame.extended = mark > 3;
  return frame;
}

Scene can_scene(const std::vector<CanDriveOptions>& drives, const CanLineOptions& line) {
  const auto bench = std::make_shared<CanBench>(drives, line);
  Scene scene;
  add_line(scene, bench);
  scene.send = [bench](const std::string& text) {
    bench->received.clear();
    for (const std::string& frame : words_of(text)) bench->send(frame_in(frame));
  };
  scene.received = [bench] {
    std::string all;
    for (const CanToHost& frame : bench->received) all += text_of(frame.frame) + ' ';
    return all;
  };
  if (KincoDrive* drive = bench->line.kinco(0)) add_kinco(scene, bench, *drive);
  if (LeadshineDrive* drive = bench->line.leadshine(0)) add_leadshine(scene, bench, *drive);
  if (KeyaDrive* drive = bench->line.keya(0)) add_keya(scene, bench, *drive);
  // So many frames of this identifier since the last request: "frames 181 3".
  scene.acts["frames"] = [bench](const Row& words) {
    const std::uint32_t id = frame_in(words[0] + "#").id;
    const auto found = std::ranges::count_if(bench->received, [id](const CanToHost& it) { return it.frame.id == id; });
    EXPECT_NEAR(static_cast<double>(found), std::stod(words[1]), words.size() > 2 ? std::stod(words[2]) : 0);
  };
  // The newest of its identifier.
  scene.acts["newest"] = [bench](const Row& words) {
    const BusFrame wanted = frame_in(words[0]);
    EXPECT_EQ(to_hex(bench->heard(wanted.id)), to_hex(bytes_of(wanted)));
  };
  scene.acts["among"] = [bench](const Row& words) {
    const BusFrame wanted = frame_in(words[0]);
    EXPECT_TRUE(std::ranges::any_of(bench->received, [&](const CanToHost& it) { return it.frame == wanted; }));
  };
  scene.acts["nmt"] = [bench](const Row& words) {
    bench->send(bus_frame(cob::nmt, {static_cast<std::uint8_t>(std::stoi(words[0], nullptr, 16)), 1}));
  };
  scene.acts["connect"] = [bench](const Row& words) { bench->line.connect(std::stoul(words[0]), on(words)); };
  scene.acts["add_twin"] = [bench](const Row&) { bench->line.add_twin(0); };
  scene.acts["bus_off"] = [bench](const Row& words) { bench->line.set_bus_off(on(words)); };
  scene.acts["broken_off"] = [bench](const Row&) {
    ASSERT_EQ(bench->received.size(), 1U);
    EXPECT_LT(bench->received[0].frame.size, 8);
  };
  scene.facts["overlaps"] = count([bench] { return bench->line.overlapping_requests(); });
  if (bench->line.canopen(0) != nullptr) {
    scene.facts["nmt_state"] = count([bench] { return static_cast<int>(bench->line.node(0).state()); });
  }
  scene.read = [bench](const std::string& text) -> std::optional<std::int64_t> {
    const Name name(text);
    const Bytes reply = bench->sdo(sdo_request(0x40, name.key()), name.station);
    if (reply.empty() || (reply[0] & 0xE3) != 0x43) return std::nullopt;
    const auto value = little_endian(CanView(reply).subspan(4, static_cast<std::size_t>(4 - (reply[0] >> 2 & 3))));
    return reply[0] == 0x43 ? std::int64_t{static_cast<std::int32_t>(value)} : std::int64_t{value};
  };
  scene.write = [bench](const std::string& text, std::int64_t value) -> std::optional<std::uint32_t> {
    const Name name(text);
    std::size_t width = static_cast<std::size_t>(name.width);
    for (std::size_t i = 0; width == 0 && i < bench->line.size(); ++i) {
      if (bench->line.node(i).node() != name.station) continue;
      const auto held = bench->line.node(i).peek(name.key(), bench->now);
      width = held ? held->size() : 4;
    }
    const Bytes reply =
        bench->sdo(sdo_request(sdo_write(width), name.key(), static_cast<std::uint32_t>(value)), name.station);
    if (reply.empty()) return std::nullopt;
    return reply[0] == 0x80 ? little_endian(CanView(reply).subspan(4)) : 0;
  };
  const auto write = scene.write;
  add_controlword(scene, [write](std::uint16_t word) { (void)write("6040", word); });
  scene.phrases["enable"] = "control 06 07 0F";
  scene.phrases["command"] = "control 06";
  scene.phrases["ramps"] = "6083 := 250000; 6084 := 250000";
  return scene;
}

// Keya's own protocol in 29 bits.
Scene keya_can_scene(const KeyaOptions& options) {
  const auto bench = std::make_shared<CanBench>(std::vector<CanDriveOptions>{KeyaCanDrive{options}});
  Scene scene;
  add_line(scene, bench);
  add_keya(scene, bench, *bench->line.keya(0));
  const auto ask = [bench](const Bytes& request) {
    bench->received.clear();
    BusFrame frame = bus_frame(keya_can::command + 1, request);
    frame.extended = true;
    bench->send(frame);
    return bench->heard(keya_can::reply + 1);
  };
  scene.send = [ask](const std::string& hex) { (void)ask(from_hex(hex)); };
  scene.received = [bench] { return to_hex(bench->heard(keya_can::reply + 1)); };
  scene.write = [ask](const std::string& text, std::int64_t value) -> std::optional<std::uint32_t> {
    Bytes request = sdo_request(0x23, Name(text).key());
    put_big_endian(std::span(request).last(4), value);
    return ask(request).empty() ? std::nullopt : std::optional<std::uint32_t>(0);
  };
  scene.read = [ask](const std::string& text) -> std::optional<std::int64_t> {
    const Bytes reply = ask(sdo_request(0x40, Name(text).key()));
    return reply.empty() ? std::nullopt : std::optional<std::int64_t>(big_endian(std::span(reply).subspan(4)));
  };
  return scene;
}

}  // namespace

Maker can(const std::vector<CanDriveOptions>& drives, const CanLineOptions& line) {
  return [=](const Row&) { return can_scene(drives, line); };
}

Maker ld2(const Patch<LeadshineOptions>& patch) {
  LeadshineOptions options;
  if (patch) patch(options);
  return can({options});
}

Maker can_kinco(KincoType type, const Patch<KincoCanDrive>& patch) {
  KincoCanDrive options = a_can_kinco(type);
  if (patch) patch(options);
  return can({options});
}

Maker keya_own_can(const KeyaOptions& options) {
  return [=](const Row&) { return keya_can_scene(options); };
}

Maker keya_canopen(const KeyaOptions& options) { return can({KeyaCanopenDrive{options}}); }

Maker keya_own_can_if(bool KeyaOptions::*open, KeyaOptions options) {
  return [=](const Row& row) mutable {
    options.*open = row.at(0) == "1";
    return keya_can_scene(options);
  };
}

}  // namespace axisgate::simulated
