// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/answering_line.hpp"

#include "tests/bench/lawicel_lines.hpp"
#include "tests/simulated/can_line.hpp"
#include "tests/simulated/lawicel_text.hpp"
#include "tests/simulated/socket_can_line.hpp"

namespace axisgate::bench {
namespace {

using simulated::BusFrame;
using simulated::Time;
using Octets = std::vector<std::uint8_t>;

simulated::CanDriveOptions jd_at(int number) {
  simulated::KincoCanDrive drive;
  drive.drive.station = static_cast<std::uint8_t>(number);
  // One gateway after the other is ended and begun on the same node: what that does to a motor is no matter here.
  drive.can.stops_without_master = false;
  return drive;
}

class AnsweringCan final : public AnsweringLine {
 public:
  AnsweringCan(LineProtocol protocol, int drives, Time now) : lawicel_(protocol == LineProtocol::slcan) {
    for (int number = 1; number <= drives; ++number) {
      nodes_.push_back(simulated::make_can_node(jd_at(number)));
      nodes_.back()->advance(now);
    }
  }

  std::optional<Answer> hear(std::span<const std::uint8_t> bytes, std::uint8_t mute, Time now) override {
    std::optional<Answer> answer;
    for (const std::uint8_t byte : bytes) {
      const auto frame = lawicel_ ? heard_by_adapter(byte) : heard_by_interface(byte);
      if (!frame) continue;
      for (const auto& node : nodes_)
        if (node->node() != mute) take(*node, *frame, now, answer);
    }
    return answer;
  }

  Octets unasked(Time now) override {
    for (const auto& node : nodes_) {
      node->advance(now);
      for (const auto& output : node->take_output()) append(unasked_, output.frame);
    }
    return std::exchange(unasked_, {});
  }

  /// TPDO 1 as the gateway has mapped it, with another position: counts of whole turns.
  Octets turned(int turns) override {
    simulated::CanopenNode& node = *nodes_.front();
    Octets bytes;
    if (node.state() != simulated::NmtState::operational) return bytes;
    constexpr std::uint16_t kMap = 0x1A00, kPosition = 0x6063;
    simulated::CanBytes data;
    const auto entries = node.peek({kMap, 0}, {}).value_or(simulated::CanBytes{0}).front();
    for (std::uint8_t sub = 1; sub <= entries; ++sub) {
      const std::uint32_t entry = simulated::little_endian(*node.peek({kMap, sub}, {}));
      const auto index = static_cast<std::uint16_t>(entry >> 16);
      auto value = *node.peek({index, static_cast<std::uint8_t>(entry >> 8)}, {});
      if (index == kPosition) value = simulated::little_endian(static_cast<std::uint32_t>(turns) * kCountsPerTurn, 4);
      data.insert(data.end(), value.begin(), value.end());
    }
    append(bytes, simulated::bus_frame(simulated::cob::first_tpdo + node.node(), data));
    return bytes;
  }

 private:
  static constexpr std::uint32_t kCountsPerTurn = 10'000;

  void take(simulated::CanopenNode& node, const BusFrame& frame, Time now, std::optional<Answer>& answer) {
    constexpr std::uint8_t kDownload = 1;
    node.hear(frame, 1, now);
    for (const auto& output : node.take_output()) {
      if (!output.answer || frame.remote) {
        append(unasked_, output.frame);
        continue;
      }
      answer = Answer{{.object = static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8),
                       .write = frame.data[0] >> 5 == kDownload},
                      {}};
      append(answer->bytes, output.frame);
    }
  }

  /// An adapter acknowledges each line; while its channel is closed nothing passes.
  std::optional<BusFrame> heard_by_adapter(std::uint8_t byte) {
    const auto line = lines_.take(byte);
    if (!line) return std::nullopt;
    const auto frame = simulated::lawicel_frame(*line);
    if (*line == "O" || *line == "C") open_ = *line == "O";
    const std::string_view acknowledgement = frame                    ? "z\r"
                                             : line->starts_with('V') ? "V1013\r"
                                             : line->starts_with('N') ? "NA123\r"
                                             : line->starts_with('F') ? "F00\r"
                                                                      : "\r";
    unasked_.insert(unasked_.end(), acknowledgement.begin(), acknowledgement.end());
    return open_ ? frame : std::nullopt;
  }

  std::optional<BusFrame> heard_by_interface(std::uint8_t byte) {
    begun_.push_back(byte);
    if (begun_.size() < simulated::socket_frame_bytes) return std::nullopt;
    return simulated::frame_of_socket(std::exchange(begun_, {}));
  }

  void append(Octets& to, const BusFrame& frame) const {
    if (!lawicel_) {
      const auto bytes = simulated::socket_frame_of(frame);
      to.insert(to.end(), bytes.begin(), bytes.end());
    } else if (open_) {
      const std::string text = simulated::lawicel_text(frame) + '\r';
      to.insert(to.end(), text.begin(), text.end());
    }
  }

  bool lawicel_;
  bool open_ = false;
  std::vector<std::unique_ptr<simulated::CanopenNode>> nodes_;
  LawicelLines lines_;
  Octets begun_;
  Octets unasked_;
};

}  // namespace

std::unique_ptr<AnsweringLine> make_answering_can(LineProtocol protocol, int drives, Time now) {
  return std::make_unique<AnsweringCan>(protocol, drives, now);
}

}  // namespace axisgate::bench
