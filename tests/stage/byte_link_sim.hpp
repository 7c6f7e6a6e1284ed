// SPDX-License-Identifier: Apache-2.0
// A ByteLink whose far end is a simulated line of Kincos or Keyas, in manual time. Never delivers a byte from inside
// send().
#pragma once

#include <utility>

#include "adapters/bus/byte_link.hpp"
#include "tests/simulated/keya_line.hpp"
#include "tests/simulated/serial_line.hpp"
#include "tests/stage/serial_cable.hpp"

namespace axisgate::test {

template <class Line, class Options>
class ByteLinkSim final : public bus::ByteLink, public SerialCable {
 public:
  ByteLinkSim(ManualRuntime& runtime, const Options& options, std::uint64_t seed)
      : SerialCable(runtime, line_), line_(options, simulated::Random(seed), sink()) {}

  [[nodiscard]] Line& line() { return line_; }

  void start(bus::ByteLinkEvents& events) override {
    events_ = &events;
    arrived_.clear();
    wake();
  }
  void send(Bytes bytes) override {
    if (!up_ || last_words.dead()) return;
    advance_drives();  // what came until now was heard before
    bytes = bytes.first(last_words.take(bytes.size()));
    sent.push_back({runtime_.now(), {bytes.begin(), bytes.end()}});
    carry(bytes);
  }
  void reopen(std::string_view why) override {
    arrived_.clear();
    line_.cut();
    if (!up_) return;
    up_ = false;
    events_->on_link_down(why);
    wake();  // and up again with the next turn
  }
  /// Whoever held it has died: what it sent is on its way, what it has not taken is gone. start() takes it up again.
  void let_go() {
    events_ = nullptr;
    up_ = false;
    last_words.live();
    forget_heard();
  }

  struct Sent {
    Instant at;
    std::vector<Byte> bytes;
  };
  /// Everything the gateway has sent.
  std::vector<Sent> sent;

 private:
  void hear(simulated::Time, std::vector<Byte> bytes) override {
    arrived_.insert(arrived_.end(), bytes.begin(), bytes.end());
  }
  /// A Kinco's error (0x80, detail 0x06090030). A Keya has none.
  std::vector<Byte> refusal(Bytes request) override {
    if constexpr (std::is_same_v<Line, simulated::KeyaLine>) return {};
    const auto frame =
        simulated::seal(request[0], simulated::FrameCommand::error,
                        static_cast<std::uint16_t>(request[2] | request[3] << 8), request[4], 0x06090030);
    return {frame.begin(), frame.end()};
  }
  void forget() override { arrived_.clear(); }
  bool deliver() override {
    if (events_ == nullptr) return false;
    tell_plugged(*events_);
    if (up_ && !arrived_.empty()) {
      const std::vector<Byte> bytes = std::exchange(arrived_, {});
      on_traffic(false, bytes);
      events_->on_bytes(bytes);
    }
    return true;
  }
  [[nodiscard]] Instant due() const override { return arrived_.empty() ? kNever : runtime_.now(); }

  Line line_;
  std::vector<Byte> arrived_;
  bus::ByteLinkEvents* events_ = nullptr;
};

using SimLink = ByteLinkSim<simulated::SerialLine, simulated::LineOptions>;
using KeyaLinkSim = ByteLinkSim<simulated::KeyaLine, simulated::KeyaLineOptions>;

}  // namespace axisgate::test
