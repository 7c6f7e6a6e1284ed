// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/answering_line.hpp"

#include "tests/bench/rtu_requests.hpp"
#include "tests/simulated/frame_receiver.hpp"
#include "tests/simulated/kinco_drive.hpp"
#include "tests/simulated/kinco_rtu.hpp"

namespace axisgate::bench {
namespace {

using simulated::Time;

simulated::DriveOptions drive_at(int station) {
  simulated::DriveOptions options;
  options.station = static_cast<std::uint8_t>(station);
  return options;
}

class KincoLine final : public AnsweringLine {
 public:
  KincoLine(int drives, Time now) {
    for (int station = 1; station <= drives; ++station) {
      drives_.push_back(std::make_unique<simulated::KincoDrive>(drive_at(station)));
      drives_.back()->advance(now);
    }
  }

  std::optional<Answer> hear(std::span<const std::uint8_t> bytes, std::uint8_t mute, Time now) override {
    std::optional<Answer> answer;
    for (const std::uint8_t byte : bytes) {
      const auto request = receiver_.receive(byte, now);
      if (!request) continue;
      for (const auto& drive : drives_) {
        if (drive->station() != simulated::station_of(*request) || drive->station() == mute) continue;
        const bool write = simulated::command_of(*request) != simulated::FrameCommand::read;
        const auto reply = drive->answer(*request, 0, now);
        if (!reply) continue;
        const std::uint16_t object = simulated::index_of(*request);
        answer = Answer{{.object = object, .write = write}, {reply->begin(), reply->end()}};
      }
    }
    return answer;
  }

 private:
  std::vector<std::unique_ptr<simulated::KincoDrive>> drives_;
  simulated::FrameReceiver receiver_;
};

class RtuLine final : public AnsweringLine {
 public:
  RtuLine(int drives, Time now) {
    for (int station = 1; station <= drives; ++station) {
      drives_.push_back(std::make_unique<simulated::KincoRtu>(simulated::KincoRtuDrive{drive_at(station), {}}));
      drives_.back()->advance(now);
    }
  }

  std::optional<Answer> hear(std::span<const std::uint8_t> bytes, std::uint8_t mute, Time now) override {
    std::optional<Answer> answer;
    for (const std::uint8_t byte : bytes)
      if (const auto request = requests_.take(byte, now)) answer = answer_to(*request, mute, now);
    return answer;
  }

 private:
  std::optional<Answer> answer_to(const simulated::RtuFrame& request, std::uint8_t mute, Time now) {
    for (const auto& drive : drives_) {
      if (drive->unit() != request.unit || drive->unit() == mute) continue;
      const bool write = request.pdu[0] != simulated::function::read;
      return Answer{{.object = simulated::word_at(request.pdu, 1), .write = write},
                    simulated::seal_rtu(request.unit, drive->answer(request.pdu, 0, now))};
    }
    return std::nullopt;
  }

  std::vector<std::unique_ptr<simulated::KincoRtu>> drives_;
  RtuRequests requests_;
};

}  // namespace

std::unique_ptr<AnsweringLine> make_answering_line(LineProtocol protocol, int drives, Time now) {
  if (is_can(protocol)) return make_answering_can(protocol, drives, now);
  if (protocol == LineProtocol::modbus_rtu) return std::make_unique<RtuLine>(drives, now);
  return std::make_unique<KincoLine>(drives, now);
}

}  // namespace axisgate::bench
