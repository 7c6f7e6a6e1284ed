// SPDX-License-Identifier: Apache-2.0
// The SDO client of one bus: one exchange outstanding, and for each node at most one open transfer.
// Promises that a reply ends only the exchange that asked for it; that a transfer which something else interrupts, or
// which is given up, is aborted at its server; that a second reply to a finished request is reported; that an abort
// which names no object is believed only where nothing else is left that it could answer. Never sends: it says what to
// send. Never looks at a clock.
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <optional>
#include <variant>

#include "adapters/canopen/cob_id.hpp"
#include "adapters/canopen/sdo/sdo_download.hpp"
#include "adapters/canopen/sdo/sdo_upload.hpp"

namespace axisgate::canopen {

class SdoClient {
 public:
  /// A second reply that comes within two of `timeout` is another device's.
  explicit SdoClient(Duration timeout) : duplicate_window_(2 * timeout) {}
  /// The node's server offers block transfer.
  void offer_block(std::uint8_t node) { servers_.at(node).block = true; }

  /// To send to exchange.node; `over` where there is nothing to wait for: Part::next, and no such transfer is open.
  /// Only while nothing is outstanding.
  [[nodiscard]] SdoStep begin(const bus::Exchange& exchange);

  struct Heard {
    enum class What : std::uint8_t {
      mine,          ///< `step` says how it goes on
      late,          ///< a reply to nothing that is waited for
      second_reply,  ///< a second reply to a request that is finished
      bad,           ///< no reply
    };
    What what = What::bad;
    SdoStep step{};
    bool acknowledges_write = false;  ///< of `late` and `second_reply`: the drive may hold another number since
  };
  [[nodiscard]] Heard take(std::uint8_t node, Bytes bytes, Instant now);

  /// What a server was asked for and what it answered in its place.
  struct Instead {
    ObjectAddress asked;
    ObjectAddress answered;
  };
  struct Abandoned {
    SdoFrames frames{};
    std::optional<Instead> instead{};
  };
  /// The exchange outstanding timed out; its transfer is over. To send to its node.
  [[nodiscard]] Abandoned abandon();
  /// The open transfer of a node ends because something else is done with the node. To send to it.
  [[nodiscard]] SdoFrames interrupt(std::uint8_t node);
  /// The node has restarted: it knows of no transfer. What was asked is over; its answer may come all the same.
  void restarted(std::uint8_t node);
  /// The link is lost.
  void reset();

  [[nodiscard]] std::optional<std::uint8_t> outstanding_node() const { return outstanding_; }

 private:
  using Transfer = std::variant<SdoUpload, SdoDownload>;
  /// A drive is taken for gone after three requests that it has not answered.
  static constexpr std::size_t kMaxGivenUp = 8;
  struct Finished {
    SdoReply reply;
    Instant at;
  };
  struct Server {
    bool block = false;
    std::optional<Transfer> transfer{};
    std::optional<Finished> finished{};
    std::uint8_t owed = 0;  ///< replies to requests that were given up
    /// Objects of requests that were given up, or ended by an abort of ours, which may still be answered. A server
    /// answers in order: the answer to another object shows that nothing of it comes any more.
    boost::container::static_vector<ObjectAddress, kMaxGivenUp> given_up{};
    bool gave_up_more = false;                ///< than `given_up` holds: until the node or the link restarts
    std::optional<ObjectAddress> stranger{};  ///< answered, while another object was waited for

    [[nodiscard]] bool may_still_answer() const { return gave_up_more || !given_up.empty(); }
    [[nodiscard]] bool may_still_answer(ObjectAddress object) const;
    void give_up(ObjectAddress object);
    void answered(ObjectAddress object);
  };

  [[nodiscard]] static ObjectAddress object_of(const Transfer& transfer);
  [[nodiscard]] static SdoFrame named(const Server& server, Bytes bytes);
  [[nodiscard]] Heard not_mine(Server& server, bool waited_for, Bytes bytes, Instant now) const;

  Duration duplicate_window_;
  std::array<Server, kLastNode + 1> servers_;
  std::optional<std::uint8_t> outstanding_;
};

}  // namespace axisgate::canopen
