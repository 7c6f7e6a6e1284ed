// SPDX-License-Identifier: Apache-2.0
// All that is known of the gateway: what is newest, and what was before. Promises that each store sees each record.
// Never decides what a record means: the stores do.
#pragma once

#include "gateway/upstream/web_process/capture/recorder.hpp"
#include "gateway/upstream/web_process/history/history.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

struct Stores {
  explicit Stores(std::size_t history_bytes, CaptureSettings captures = {}, std::size_t capture_bytes = kCaptureBytes)
      : history(history_bytes), recorder(std::move(captures), capture_bytes) {}

  /// False: the gateway never sends such a record.
  [[nodiscard]] bool take(const Record& record, const Now& now) {
    const auto* hello = std::get_if<HelloRecord>(&record);
    if (hello != nullptr) recorder.begin(history, now);
    if (!picture.take(record, now.at)) return false;
    if (hello != nullptr) history.take(*hello);
    if (const auto* info = std::get_if<AxisInfoRecord>(&record)) history.take(*info);
    if (const auto* samples = std::get_if<SamplesRecord>(&record)) {
      history.take(*samples);
      recorder.take(*samples, picture, history, now);
    }
    if (const auto* event = std::get_if<EventRecord>(&record)) recorder.take(*event, picture, history, now);
    return true;
  }

  /// As Recorder::turn().
  [[nodiscard]] Recorder::Turn turn(const Now& now) { return recorder.turn(picture, history, now); }

  Picture picture;
  History history;
  Recorder recorder;
};

}  // namespace axisgate::web
