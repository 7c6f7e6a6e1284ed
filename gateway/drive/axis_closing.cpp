// An axis when the gateway ends on purpose, or lets go of its drive (design 7).
#include "gateway/drive/admission.hpp"
#include "gateway/drive/axis.hpp"

namespace axisgate::drive {

void Axis::close() {
  core_.now = host_.now();
  core_.link = host_.link_state();
  closing_ = true;
  std::vector<bus::OrderId> waiting;
  std::vector<bus::OrderId> begun;
  for (const Pending& pending : pending_)
    if (ends_with_gateway(pending)) (pending.conversation->begun() ? begun : waiting).push_back(pending.id);
  for (const bus::OrderId id : waiting) on_order_ended(id, Errc::never_started);
  // Those that wait for their next step have their turn at once; of one on the wire the reply is awaited.
  for (const bus::OrderId id : begun) host_.order_waits(id, core_.now);
}

// Of a stop, what stands beside it ends with the gateway; the stop does not.
bool Axis::ends_with_gateway(const Pending& pending) const {
  return closing_ && (!pending.conversation->is_stop() || pending.conversation->stop_is_over());
}

// Some of its steps were sent, and nobody will see what comes of them.
void Axis::end_begun(Pending& pending) {
  pending.conversation->abort(refusal(Errc::timed_out));
  complete(pending.id, pending.conversation->result());
}

}  // namespace axisgate::drive
