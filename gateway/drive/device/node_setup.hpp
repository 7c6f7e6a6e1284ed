// SPDX-License-Identifier: Apache-2.0
// How a CANopen node is made ready beyond its setup list (design 7, point 6): identity, TPDO mapping, NMT. Pure.
// Promises the order of CiA 301 section 7.5.2.36 (off, count 0, entries, count, on), in pre-operational alone; that an
// object which the drive will not map costs that object alone and is polled instead; that a TPDO whose mapping does not
// read back as it was written is left off. Never starts a node, nor maps anything of one, whose motor may be enabled:
// the bring-up does not come here then.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

using bus::NmtCommand;
[[nodiscard]] bus::Exchange nmt(std::uint8_t node, NmtCommand command);

/// The 1018h numbers that are configured, read and compared.
class IdentityCheck {
 public:
  explicit IdentityCheck(const model::DriveModel& model) : model_(model) {}
  void begin();
  /// The next read; none: all are known.
  [[nodiscard]] std::optional<bus::Exchange> next() const;
  /// Of the exchange given by next(): an answer or a refusal.
  void on_result(const bus::ExchangeResult& result);
  /// "vendor is 0x1, configured 0x2" for each that differs; empty: it is the configured drive, so far as known.
  [[nodiscard]] const std::string& mismatch() const { return mismatch_; }

 private:
  void skip();
  const model::DriveModel& model_;
  std::size_t at_ = 0;
  std::string mismatch_;
};

/// A TPDO as the drive has taken it.
struct MappedTpdo {
  std::uint8_t number = 1;
  std::vector<model::ObjectId> objects;
  std::optional<std::uint16_t> event_ms{};  ///< none: the drive did not take the event timer
  friend bool operator==(const MappedTpdo&, const MappedTpdo&) = default;
};

class NodeSetup {
 public:
  explicit NodeSetup(const model::DriveModel& model) : model_(model) {}
  void begin();
  /// The next exchange; none: it is over. The same answer until on_result().
  [[nodiscard]] std::optional<bus::Exchange> next() const;
  /// Of the exchange given by next(): an answer or a refusal. What was lost is simply done once more: each write here
  /// does the same however often it is done.
  void on_result(const bus::ExchangeResult& result);

  /// What came of it, once next() gives nothing more.
  [[nodiscard]] const std::vector<MappedTpdo>& mapped() const { return mapped_; }
  /// What the drive would not do, for the log: "TPDO 1 does not take following_error (0x06040041): it is polled".
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  enum class Step : std::uint8_t {
    pre_operational,
    read_unused,  ///< 180xh:01 of a TPDO that is switched off
    switch_off,   ///< if it is on
    read_cob_id,  ///< of a TPDO that is mapped
    disable,      ///< bit 31
    clear_count,  ///< 1A0xh:00 = 0
    entry,        ///< 1A0xh:01..
    count,
    type,
    inhibit,
    event,
    enable,
    read_count,
    read_entry,  ///< each one that was taken: a drive may acknowledge a mapping and keep its own
    read_enabled,
    start,
    over,
  };
  [[nodiscard]] bus::Exchange parameter(bus::Access access, std::uint8_t sub, std::uint8_t size,
                                        std::uint32_t raw = 0) const;
  [[nodiscard]] bus::Exchange mapping(bus::Access access, std::uint8_t sub, std::uint8_t size,
                                      std::uint32_t raw = 0) const;
  [[nodiscard]] const model::TpdoProperties& tpdo() const { return model_.canopen.tpdos[at_]; }
  [[nodiscard]] std::uint8_t number() const;
  [[nodiscard]] std::uint32_t mapping_entry(model::ObjectId object) const;
  void begin_tpdo(std::size_t at);
  void begin_unused(std::size_t at);
  void give_up(const std::string& why);
  void note(std::string text) { notes_.push_back("TPDO " + std::to_string(number()) + " " + std::move(text)); }

  const model::DriveModel& model_;
  Step step_ = Step::over;
  std::size_t at_ = 0;        ///< TPDO, or unused TPDO
  std::size_t entry_at_ = 0;  ///< of its map
  std::uint32_t cob_id_ = 0;  ///< as read, without bit 31
  MappedTpdo taken_;
  std::vector<MappedTpdo> mapped_;
  std::vector<std::string> notes_;
};

}  // namespace axisgate::drive
