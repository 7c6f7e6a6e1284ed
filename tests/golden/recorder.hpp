// SPDX-License-Identifier: Apache-2.0
// Writes down one story from the bus bytes to the Modbus frames: virtual time, what went over the cable, what the image
// showed, what the client asked and was answered. Promises the same text for the same story, and that polling does not
// drown it: only class fast is polled, each 100 ms. Never judges: the text is compared with the file of the story.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/session/session.hpp"
#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {

class Recorder {
 public:
  /// One drive of this type on one line, axis 1. `bring_up`: whether the bring-up is part of the story.
  Recorder(simulated::KincoType type, bool bring_up);
  /// The same on a Modbus RTU line.
  Recorder(const simulated::RtuDriveOptions& drive, bool bring_up);
  /// The same on a CAN bus; a frame is told by its identifier and its bytes.
  Recorder(const simulated::CanDriveOptions& drive, bool bring_up);
  /// As a story's first line says: "# kinco-jd on kinco-serial at address 1", with ", from its bring-up" behind it. A
  /// profile of no simulated drive's own name is of a CiA 402 drive on canopen. It is the first line of this one too.
  explicit Recorder(const std::string& first_line);

  /// A remark of the teller, as a line of its own.
  void say(const std::string& text);
  /// A line of a story: what the client does, or "600 ms pass", is done and told; anything else is said.
  void tell(const std::string& remark);
  /// FC 16 at `100 + offset`; runs until the reply is there.
  void write(std::uint16_t offset, const std::vector<std::uint16_t>& registers);
  void coil(std::uint16_t number, bool on);
  void read(std::uint16_t offset, std::uint16_t count);
  void run(Duration time);
  [[nodiscard]] GatewayStage& stage() { return stage_; }
  [[nodiscard]] simulated::DriveFaults& faults() {
    return rtu_ ? stage_.rtu_link(0).line().faults(0) : stage_.link(0).line().faults(0);
  }
  /// CANopen: its power goes and comes back.
  void restart();
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  Recorder(const GatewayStage::Line& line, bool bring_up);
  struct Subject;
  explicit Recorder(const Subject& subject);
  void line(const std::string& who, const std::string& what);
  void send(std::vector<Byte> pdu, const std::string& meaning);
  void take_output();
  void step();
  void show_image();

  bool rtu_;
  GatewayStage stage_;
  modbus_tcp::ListenerSettings settings_;
  modbus_tcp::ClientRegistry registry_;
  Log quiet_;
  std::unique_ptr<modbus_tcp::Session> session_;
  std::string text_;
  Instant began_;
  bool recording_ = false;
  std::uint16_t transaction_ = 0;
  std::size_t replies_ = 0;
  std::map<std::string, std::string> shown_;
};

}  // namespace axisgate::test
