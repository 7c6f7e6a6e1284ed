// SPDX-License-Identifier: Apache-2.0
// Who is let in, and who gets an answer: the networks that may look, how many at once and how often, and by which name
// they call us. Promises that every refusal is counted by its reason. Never touches a socket.
#pragma once

#include <string>
#include <vector>

#include "gateway/upstream/web_process/api/router.hpp"
#include "gateway/upstream/web_process/http/address.hpp"
#include "gateway/upstream/web_process/http/settings.hpp"
#include "gateway/upstream/web_process/http/token_buckets.hpp"

namespace axisgate::web {

struct Peer {
  Address address{};  ///< who asks
  Address reached{};  ///< ours that was asked
};

class Reception {
 public:
  explicit Reception(const Settings& settings);

  /// Why a connection that has come is not kept; nothing: it is, until leave().
  [[nodiscard]] std::optional<Refusal> enter(const Address& address);
  void leave() { --served_.connections; }
  /// A stream that was answered has ended.
  void end_stream() { --served_.streams; }

  /// A stream that is answered counts until end_stream().
  [[nodiscard]] Answer answer(const Request& request, const Peer& peer, const Stores& stores, const Now& now);
  /// A refusal that something else has met.
  void count(Refusal refusal) { served_.refused.count(refusal); }
  void confined(bool confined) { served_.confined = confined; }
  [[nodiscard]] const Served& served() const { return served_; }

 private:
  [[nodiscard]] bool allows(const Address& address) const;
  const Settings settings_;
  TokenBuckets buckets_;
  Served served_{};
};

}  // namespace axisgate::web
