// SPDX-License-Identifier: Apache-2.0
// The session before an image that the test writes itself and a command port that it plays itself.
// Promises that nothing is read from the session but by the test. Never decides what is right.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gateway/upstream/dds/dds_session.hpp"
#include "tests/unit/dds/fake_port.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::test {

/// An axis that has everything, and is there.
inline AxisImage& add_axis(ProcessImage& image, AxisNumber number) {
  AxisImage& axis = image.add_axis(number, "axis " + std::to_string(number), 0);
  axis.supported = axis.writable = UINT32_MAX;
  axis.supported_commands = (2U << kLastCommand) - 1;
  axis.link_state = LinkState::online;
  for (const QuantityRow& each : quantity_table()) axis[each.quantity] = {0, true, true, kStart};
  return axis;
}

struct PlainSession {
  explicit PlainSession(AxisNumber axes = 1, dds::DdsSettings with = settings()) {
    for (AxisNumber n = 1; n <= axes; ++n) add_axis(image, n);
    session = std::make_unique<dds::DdsSession>(
        std::move(with), image, ring, port, [this] { ++woken; },
        dds::DdsDomainReports{[this](const std::string& line) { told.push_back(line); },
                              [this](bool taken, const std::string&) { name_taken.push_back(taken); }});
    session->on_link_up(now);
  }

  static dds::DdsSettings settings() {
    dds::DdsSettings out;
    out.commands = true;
    return out;
  }

  /// All that is due now.
  std::vector<dds::Record> read() {
    std::vector<dds::Record> out;
    while (auto record = session->next(now)) out.push_back(std::move(*record));
    return out;
  }
  /// Those of one kind.
  template <typename R>
  std::vector<R> read() {
    std::vector<R> out;
    for (const dds::Record& record : read())
      if (const auto* const each = std::get_if<R>(&record)) out.push_back(*each);
    return out;
  }
  /// The one reply to it; 0: none, or more than one.
  template <typename R = dds::ReplyRecord>
  int ask(const dds::Record& record) {
    static_cast<void>(read());
    session->on_record(record, now);
    const auto replies = read<R>();
    return replies.size() == 1 ? replies.front().result : 0;
  }
  void change(AxisNumber number, std::int64_t position) {
    AxisImage& axis = *image.find(number);
    axis[Quantity::position_actual].value = position;
    ++axis.sequence;
    image.changes.mark(number);
  }

  Instant now = kStart;
  int woken = 0;
  std::vector<std::string> told;
  std::vector<bool> name_taken;
  ProcessImage image;
  EventRing ring{[this](const Event&) { image.changes.mark(0); }};
  FakePort port;
  std::unique_ptr<dds::DdsSession> session;
};

}  // namespace axisgate::test
