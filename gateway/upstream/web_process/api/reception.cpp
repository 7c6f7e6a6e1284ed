// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/reception.hpp"

#include <algorithm>

namespace axisgate::web {

Reception::Reception(const Settings& settings) : settings_(settings) { served_.insecure = settings.insecure; }

bool Reception::allows(const Address& address) const {
  if (settings_.allow.empty()) return is_loopback(address);
  return std::ranges::any_of(settings_.allow, [&](const Network& each) { return each.holds(address); });
}

std::optional<Refusal> Reception::enter(const Address& address) {
  std::optional<Refusal> refusal;
  if (!allows(address))
    refusal = Refusal::not_allowed;
  else if (served_.connections >= settings_.max_connections)
    refusal = Refusal::connections;
  if (refusal)
    count(*refusal);
  else
    ++served_.connections;
  return refusal;
}

Answer Reception::answer(const Request& request, const Peer& peer, const Stores& stores, const Now& now) {
  ++served_.requests;
  const auto refused = [this](Refusal refusal) {
    count(refusal);
    return Answer{problem(refusal), refusal};
  };
  if (!buckets_.takes(peer.address, now.at)) return refused(Refusal::rate);
  if (!names_us(request.host, peer.reached, settings_.hosts)) return refused(Refusal::host);
  Answer out = web::answer(request, stores, served_, now);
  if (out.refused) count(*out.refused);
  if (!std::holds_alternative<StreamRequest>(out.what)) return out;
  if (request.method == Request::Method::head) return {Response{.type = "text/event-stream", .close = true}};
  if (served_.streams >= settings_.max_streams) return refused(Refusal::streams);
  ++served_.streams;
  return out;
}

}  // namespace axisgate::web
