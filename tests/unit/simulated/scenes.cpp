// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iomanip>
#include <sstream>

#include "tests/unit/simulated/script.hpp"

namespace axisgate::simulated {
namespace {

FrameCommand write_command(std::size_t width) {
  if (width == 4) return FrameCommand::write_4;
  return width == 2 ? FrameCommand::write_2 : FrameCommand::write_1;
}

class KincoScene final : public Scene {
 public:
  explicit KincoScene(const std::string& line) : Scene(line) {
    phrases["store"] = "2FF0.01 := 1; pass 100ms";
    phrases["home_here"] = "control 0F; 6060 := 6; 6098 := 35; control 1F; until 6041 & 0x8000 = 0x8000";
    phrases["start_move"] = "control 2F 3F";
    phrases["ask"] = "> 01 40 41 60 00 00 00 00 00 1E";
    phrases["other"] = "> 01 40 63 60 00 00 00 00 00 FC";
    phrases["act"] = "> 01 2B 40 60 00 0F 00 00 00 25";
  }
  std::optional<std::int64_t> read(const Name& name) override {
    const auto reply = ask(ten_bytes(FrameCommand::read, name.key(), 0, name.station));
    if (!reply || command_of(*reply) == FrameCommand::error) return std::nullopt;
    return value_in(type_of(name.key()), data_of(*reply));
  }
  std::optional<std::uint32_t> write(const Name& name, std::int64_t value) override {
    const auto width = name.width != 0 ? name.width : static_cast<std::size_t>(bytes_of(type_of(name.key())));
    const auto data = static_cast<std::uint32_t>(value);
    const auto reply = ask(ten_bytes(write_command(width), name.key(), data, name.station));
    if (!reply) return std::nullopt;
    return command_of(*reply) == FrameCommand::error ? data_of(*reply) : 0;
  }

 private:
  ObjectType type_of(ObjectKey key) {
    const ObjectEntry* entry = bench.kinco()->entry(key);
    return entry == nullptr ? ObjectType::u32 : entry->type;
  }
  // The newest frame that came back; a chain returns the host's own before it.
  std::optional<TenByteFrame> ask(const Bytes& request) {
    const Bytes bytes = bench.exchange(request);
    TenByteFrame frame{};
    if (bytes.size() < frame_length) return std::nullopt;
    std::copy(bytes.end() - frame_length, bytes.end(), frame.begin());
    if (std::equal(frame.begin(), frame.end(), request.begin())) return std::nullopt;
    return frame;
  }
};

struct Register {
  explicit Register(const Name& name) {
    const bool kinco = name.word[0] == 'r';
    number = static_cast<std::uint16_t>(std::stoi(name.word.substr(kinco ? 1 : 0), nullptr, kinco ? 16 : 10));
    for (const Id286proRow& row : id286pro_rows()) {
      if (!kinco && name.width == 0 && row.number == number)
        words = static_cast<std::uint16_t>(row.words), is_signed = row.is_signed;
    }
    if (name.word.back() == 'L') words = 2;
    if (kinco && words == 2) is_signed = true;
  }
  std::uint16_t number;
  std::uint16_t words = 1;
  bool is_signed = false;
};

// Frames are unit and PDU; the CRC is the scene's affair.
class RtuScene final : public Scene {
 public:
  explicit RtuScene(const std::string& line) : Scene(line) {
    phrases["stands"] = "until 109 = 2";
    phrases["move_on"] = "323 := 2; stands";
    phrases["ask"] = "> 01 03 32 00 00 01";
    phrases["other"] = "> 01 03 37 00 00 02";
    phrases["act"] = "> 01 06 31 00 00 0F";
  }
  void send(const std::string& hex) override {
    const Bytes frame = from_hex(hex);
    bench.exchange(seal_rtu(frame[0], RtuView(frame).subspan(1)));
  }
  std::string received() override {
    const Bytes bytes = bench.received();
    const auto frame = open_rtu(bytes);
    if (!frame) return bytes.empty() ? "" : "no single frame: " + to_hex(bytes);
    return to_hex(std::array{frame->unit}) + to_hex(frame->pdu);
  }
  std::optional<std::int64_t> read(const Name& name) override {
    const Register it(name);
    const auto frame = open_rtu(bench.exchange(seal_rtu(name.station, read_pdu(it.number, it.words))));
    if (!frame || frame->pdu[0] != function::read) return std::nullopt;
    const std::uint32_t low = word_at(frame->pdu, 2);
    if (it.words == 1) return it.is_signed ? std::int64_t{static_cast<std::int16_t>(low)} : std::int64_t{low};
    return static_cast<std::int32_t>(low | std::uint32_t{word_at(frame->pdu, 4)} << 16);
  }
  std::optional<std::uint32_t> write(const Name& name, std::int64_t value) override {
    const Register it(name);
    const auto pdu =
        it.words == 2 ? write_long_pdu(it.number, value) : write_pdu(it.number, static_cast<std::uint16_t>(value));
    const auto frame = open_rtu(bench.exchange(seal_rtu(name.station, pdu)));
    if (!frame) return std::nullopt;
    return (frame->pdu[0] & 0x80) != 0 ? frame->pdu[1] : 0;
  }
};

// "control 3 1000 -1000": code and values; behind them the number on RS485. "query 5 1": its code, and the number.
class KeyaSerialScene final : public Scene {
 public:
  explicit KeyaSerialScene(const std::string& line) : Scene(line) {
    phrases["ask"] = "query 7";
    phrases["other"] = "query 5";
    phrases["act"] = "control 3";
  }
  bool act(const Row& words) override {
    const auto word = [&](std::size_t at, std::int64_t missing) {
      return words.size() > at ? whole(words[at]) : missing;
    };
    if (words[0] == "control") {
      ask(keya_start::control, word(1, 0), word(4, 1), word(2, 0), word(3, 0));
    } else if (words[0] == "query") {
      ask(keya_start::query, word(1, 0), word(2, 1), 0, 0);
    } else if (words[0] == "heartbeat") {
      bench.port.keya->set_heartbeat(0, milliseconds(word(1, 0)));
    } else {
      return Scene::act(words);
    }
    return true;
  }

 private:
  void ask(std::uint8_t start, std::int64_t code, std::int64_t node, std::int64_t first, std::int64_t second) {
    const bool addressed = bench.port.keya->wiring() == KeyaWiring::rs485;
    KeyaFrame frame{start, static_cast<std::uint8_t>(addressed ? node : code)};
    if (addressed) frame[2] = static_cast<std::uint8_t>(code);
    put_big_endian(std::span(frame).subspan(addressed ? 3 : 4, 4), first);
    put_big_endian(std::span(frame).subspan(addressed ? 7 : 8, 4), second);
    bench.exchange(addressed ? seal_keya(frame) : frame);
  }
};

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

// "frames 181 3": so many of this identifier since the last request; "newest 181#00" is the last of them, "among
// 181#00" one of them.
class CanScene : public Scene {
 public:
  explicit CanScene(const std::string& line) : Scene(line) {
    phrases["enable"] = "control 06 07 0F";
    phrases["ramps"] = "6083 := 250000; 6084 := 250000";
    phrases["ask"] = "> 601#4041600000000000";
    phrases["other"] = "> 601#4083600000000000";
    phrases["act"] = "> 601#2B40600006000000";
  }
  void send(const std::string& text) override {
    bench.arrivals.clear();
    for (const std::string& frame : words_of(text)) bench.send(frame_in(frame));
  }
  std::string received() override {
    std::string all;
    for (const BusFrame& frame : bench.frames()) all += text_of(frame) + ' ';
    return all;
  }
  std::int64_t fact(const std::string& name) override {
    if (name == "arrived") return static_cast<std::int64_t>(bench.frames().size());
    if (name == "revolution") return bench.bus().leadshine(0)->units_per_revolution();
    return Scene::fact(name);
  }
  bool act(const Row& words) override {
    if (words[0] == "frames") {
      const auto id = static_cast<std::uint32_t>(std::stoul(words[1], nullptr, 16));
      const auto found = std::ranges::count(bench.frames(), id, &BusFrame::id);
      EXPECT_NEAR(static_cast<double>(found), std::stod(words[2]), words.size() > 3 ? std::stod(words[3]) : 0);
    } else if (words[0] == "newest") {
      EXPECT_EQ(to_hex(bench.heard(frame_in(words[1]).id)), to_hex(bytes_of(frame_in(words[1]))));
    } else if (words[0] == "among") {
      EXPECT_EQ(std::ranges::count(bench.frames(), frame_in(words[1])), 1);
    } else {
      return Scene::act(words);
    }
    return true;
  }
  std::optional<std::int64_t> read(const Name& name) override {
    const Bytes reply = bench.sdo(sdo_request(0x40, name.key()), name.station);
    if (reply.empty() || (reply[0] & 0xE3) != 0x43) return std::nullopt;
    const auto value = little_endian(CanView(reply).subspan(4, static_cast<std::size_t>(4 - (reply[0] >> 2 & 3))));
    return reply[0] == 0x43 ? std::int64_t{static_cast<std::int32_t>(value)} : std::int64_t{value};
  }
  std::optional<std::uint32_t> write(const Name& name, std::int64_t value) override {
    const auto held = bench.bus().node(0).peek(name.key(), bench.now);
    const std::size_t width = name.width != 0 ? name.width : held ? held->size() : 4;
    const Bytes reply =
        bench.sdo(sdo_request(sdo_write(width), name.key(), static_cast<std::uint32_t>(value)), name.station);
    if (reply.empty()) return std::nullopt;
    return reply[0] == 0x80 ? little_endian(CanView(reply).subspan(4)) : 0;
  }
};

// Keya's own protocol in 29 bits: eight bytes without '#' are a command to node 1.
class KeyaCanScene final : public CanScene {
 public:
  using CanScene::CanScene;
  void send(const std::string& text) override {
    CanScene::send(text.find('#') != std::string::npos ? text : "06000001#" + without_spaces(text));
  }
  std::optional<std::uint32_t> write(const Name& name, std::int64_t value) override {
    Bytes request = sdo_request(0x23, name.key());
    put_big_endian(std::span(request).last(4), value);
    return bench.keya_can(request).empty() ? std::nullopt : std::optional<std::uint32_t>(0);
  }
  std::optional<std::int64_t> read(const Name& name) override {
    const Bytes reply = bench.keya_can(sdo_request(0x40, name.key()));
    return reply.empty() ? std::nullopt : std::optional<std::int64_t>(big_endian(std::span(reply).subspan(4)));
  }
};

// Text of the adapter: "> S6|" sends S6 and CR; BELL is written as !.
class LawicelScene final : public Scene {
 public:
  explicit LawicelScene(const std::string& line) : Scene(line) { phrases["open"] = "> S6|O| < ||; timeless"; }
  void send(const std::string& text) override {
    Bytes bytes(text.begin(), text.end());
    std::ranges::replace(bytes, std::uint8_t{'|'}, std::uint8_t{'\r'});
    bench.exchange(bytes);
  }
  std::string received() override {
    const Bytes bytes = bench.received();
    std::string text(bytes.begin(), bytes.end());
    std::ranges::replace(text, '\r', '|');
    std::ranges::replace(text, '\a', '!');
    return text;
  }
  bool act(const Row& words) override {
    if (words[0] == "timeless") bench.bus().set_bit_rate(0);
    return words[0] == "timeless" || Scene::act(words);
  }
};

}  // namespace

std::unique_ptr<Scene> scene_on(const std::string& line) {
  const LineSpec spec = spec_of(line);
  if (spec.kind == LineKind::lawicel) return std::make_unique<LawicelScene>(line);
  if (spec.kind == LineKind::rtu) return std::make_unique<RtuScene>(line);
  if (spec.kind == LineKind::kinco) return std::make_unique<KincoScene>(line);
  if (spec.is_keya_serial()) return std::make_unique<KeyaSerialScene>(line);
  if (std::holds_alternative<KeyaCanDrive>(spec.can_drives.at(0))) return std::make_unique<KeyaCanScene>(line);
  return std::make_unique<CanScene>(line);
}

}  // namespace axisgate::simulated
