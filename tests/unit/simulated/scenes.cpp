#include "tests/unit/simulated/scene_parts.hpp"

namespace axisgate::simulated {
namespace {

ObjectType type_of(const KincoDrive& drive, ObjectKey key) {
  const ObjectEntry* entry = drive.entry(key);
  return entry == nullptr ? ObjectType::u32 : entry->type;
}

FrameCommand write_command(int width) {
  if (width == 4) return FrameCommand::write_4;
  return width == 2 ? FrameCommand::write_2 : FrameCommand::write_1;
}

// The newest frame among what came back; a chain returns the host's own before it.
std::optional<TenByteFrame> reply_in(const Bytes& bytes, const Bytes& request) {
  TenByteFrame frame{};
  if (bytes.size() < frame_length) return std::nullopt;
  std::copy(bytes.end() - frame_length, bytes.end(), frame.begin());
  if (std::equal(frame.begin(), frame.end(), request.begin())) return std::nullopt;
  return frame;
}

Scene kinco_scene(const std::vector<DriveOptions>& drives, const LineOptions& line) {
  const auto bench = std::make_shared<KincoBench>(drives, line);
  Scene scene;
  add_bytes(scene, bench);
  add_kinco(scene, bench, bench->line.drive(0));
  scene.read = [bench](const std::string& text) -> std::optional<std::int64_t> {
    const Name name(text);
    const Bytes request = ten_bytes(FrameCommand::read, name.key(), 0, name.station);
    const auto reply = reply_in(bench->exchange(request), request);
    if (!reply || command_of(*reply) == FrameCommand::error) return std::nullopt;
    return value_in(type_of(bench->line.drive(0), name.key()), data_of(*reply));
  };
  scene.write = [bench](const std::string& text, std::int64_t value) -> std::optional<std::uint32_t> {
    const Name name(text);
    const int width = name.width != 0 ? name.width : bytes_of(type_of(bench->line.drive(0), name.key()));
    const auto data = static_cast<std::uint32_t>(value);
    const Bytes request = ten_bytes(write_command(width), name.key(), data, name.station);
    const auto reply = reply_in(bench->exchange(request), request);
    if (!reply) return std::nullopt;
    return command_of(*reply) == FrameCommand::error ? data_of(*reply) : 0;
  };
  add_controlword(scene, [bench](std::uint16_t word) {
    bench->exchange(ten_bytes(FrameCommand::write_2, {0x6040, 0}, word));
  });
  scene.acts["restart"] = [bench](const Row& words) {
    bench->line.restart(words.empty() ? 0 : std::stoul(words[0]), bench->now);
  };
  scene.phrases["store"] = "2FF0.01 := 1; pass 100ms";
  scene.phrases["home_here"] = "control 0F; 6060 := 6; 6098 := 35; control 1F; until 6041 & 0x8000 = 0x8000";
  scene.phrases["start_move"] = "control 2F 3F";
  return scene;
}

// Unit and PDU; the CRC is the scene's affair.
std::string opened(const Bytes& received) {
  const auto frame = open_rtu(received);
  if (!frame) return received.empty() ? "" : "no single frame: " + to_hex(received);
  Bytes bytes{frame->unit};
  bytes.insert(bytes.end(), frame->pdu.begin(), frame->pdu.end());
  return to_hex(bytes);
}

struct Register {
  explicit Register(const Name& name) {
    const bool kinco = name.word[0] == 'r';
    number = static_cast<std::uint16_t>(std::stoi(name.word.substr(kinco ? 1 : 0), nullptr, kinco ? 16 : 10));
    for (const Id286proRow& row : id286pro_rows()) {
      if (!kinco && name.width == 0 && row.number == number) words = row.words, is_signed = row.is_signed;
    }
    if (name.word.back() == 'L') words = 2;
    if (kinco && words == 2) is_signed = true;
  }
  std::uint16_t number;
  int words = 1;
  bool is_signed = false;
};

Scene rtu_scene(const std::vector<RtuDriveOptions>& drives, const RtuLineOptions& line) {
  const auto bench = std::make_shared<RtuBench>(drives, line);
  Scene scene;
  add_line(scene, bench);
  if (KincoDrive* drive = bench->line.kinco(0)) add_kinco(scene, bench, *drive);
  if (Id286pro* drive = bench->line.id286pro(0)) add_id286pro(scene, bench, *drive);
  scene.send = [bench](const std::string& hex) {
    const Bytes frame = from_hex(hex);
    bench->exchange(seal_rtu(frame[0], RtuView(frame).subspan(1)));
  };
  scene.received = [bench] { return opened(bench->received); };
  scene.read = [bench](const std::string& text) -> std::optional<std::int64_t> {
    const Name name(text);
    const Register it(name);
    const auto frame =
        open_rtu(bench->exchange(seal_rtu(name.station, read_pdu(it.number, static_cast<std::uint16_t>(it.words)))));
    if (!frame || frame->pdu[0] != function::read) return std::nullopt;
    const std::uint32_t low = word_at(frame->pdu, 2);
    if (it.words == 1) return it.is_signed ? std::int64_t{static_cast<std::int16_t>(low)} : std::int64_t{low};
    return static_cast<std::int32_t>(low | std::uint32_t{word_at(frame->pdu, 4)} << 16);
  };
  scene.write = [bench](const std::string& text, std::int64_t value) -> std::optional<std::uint32_t> {
    const Name name(text);
    const Register it(name);
    const auto pdu =
        it.words == 2 ? write_long_pdu(it.number, value) : write_pdu(it.number, static_cast<std::uint16_t>(value));
    const auto frame = open_rtu(bench->exchange(seal_rtu(name.station, pdu)));
    if (!frame) return std::nullopt;
    return (frame->pdu[0] & 0x80) != 0 ? frame->pdu[1] : 0;
  };
  scene.phrases["command"] = "> 01 06 31 00 00 0F";
  return scene;
}

// "control 3 1000 -1000", behind it the node on RS485.
Scene keya_serial_scene(KeyaWiring wiring, const std::vector<KeyaOptions>& drives) {
  const auto bench = std::make_shared<KeyaBench>(wiring, drives);
  Scene scene;
  add_bytes(scene, bench);
  add_keya(scene, bench, bench->line.drive(0));
  const bool addressed = wiring == KeyaWiring::rs485;
  scene.acts["control"] = [bench, addressed](const Row& words) {
    KeyaFrame frame{keya_start::control};
    const std::size_t at = addressed ? 2 : 1;
    frame[1] = static_cast<std::uint8_t>(words.size() > 3 ? whole(words[3]) : 1);
    frame[at] = static_cast<std::uint8_t>(whole(words[0]));
    if (words.size() > 1) put_big_endian(std::span(frame).subspan(at + (addressed ? 1 : 3), 4), whole(words[1]));
    if (words.size() > 2) put_big_endian(std::span(frame).subspan(at + (addressed ? 5 : 7), 4), whole(words[2]));
    if (addressed) frame = seal_keya(frame);
    bench->exchange({frame.begin(), frame.end()});
  };
  // A query by its code, answered with its first bytes; nothing where there is no answer.
  scene.acts["query"] = [bench, addressed](const Row& words) {
    KeyaFrame frame{keya_start::query, static_cast<std::uint8_t>(whole(words[0]))};
    if (addressed) frame = seal_keya({keya_start::query, static_cast<std::uint8_t>(whole(words[1])), frame[1]});
    bench->exchange({frame.begin(), frame.end()});
  };
  scene.phrases["command"] = "control 3 0 0";
  scene.acts["heartbeat"] = [bench](const Row& words) { bench->line.set_heartbeat(0, milliseconds(whole(words[0]))); };
  return scene;
}

}  // namespace

Maker kinco(KincoType type, const Patch<DriveOptions>& patch) {
  DriveOptions options = a_drive(type);
  if (patch) patch(options);
  return kincos({options});
}

Maker kincos(const std::vector<DriveOptions>& drives, const Patch<LineOptions>& patch) {
  LineOptions line;
  if (patch) patch(line);
  return [=](const Row&) { return kinco_scene(drives, line); };
}

Maker rtu(const std::vector<RtuDriveOptions>& drives, const RtuLineOptions& line) {
  return [=](const Row&) { return rtu_scene(drives, line); };
}

Maker rtu_kinco(KincoType type, const Patch<KincoRtuDrive>& patch) {
  KincoRtuDrive options = an_rtu_kinco(type);
  if (patch) patch(options);
  return rtu({options});
}

Maker id286pro(const Patch<Id286proOptions>& patch) {
  Id286proOptions options;
  if (patch) patch(options);
  return rtu({options});
}

Maker keya_serial(KeyaWiring wiring, const std::vector<KeyaOptions>& drives) {
  return [=](const Row&) { return keya_serial_scene(wiring, drives); };
}

Maker keya_serial_if(bool KeyaOptions::*open, KeyaWiring wiring, KeyaOptions options) {
  return [=](const Row& row) mutable {
    options.*open = row.at(0) == "1";
    return keya_serial_scene(wiring, {options});
  };
}

}  // namespace axisgate::simulated
