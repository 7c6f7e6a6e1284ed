// SPDX-License-Identifier: Apache-2.0
// An axis when the gateway ends on purpose, or lets go of its drive (design 3.4 The end on purpose).
#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/plan/admission.hpp"

namespace axisgate::drive {

void Axis::close() {
  closing_ = true;
  std::vector<bus::JobId> waiting;
  std::vector<bus::JobId> begun;
  for (const Pending& pending : pending_)
    if (ends_with_gateway(pending)) (pending.command_sequence->begun() ? begun : waiting).push_back(pending.id);
  for (const bus::JobId id : waiting) on_job_ended(id, Errc::never_started);
  // Those that wait for their next step have their turn at once; of one on the wire the reply is awaited.
  for (const bus::JobId id : begun) host_.job_waits(id, core_.turn.now);
}

// Of a stop, what stands beside it ends with the gateway; the stop does not.
bool Axis::ends_with_gateway(const Pending& pending) const {
  return closing_ && (!pending.command_sequence->is_stop() || pending.command_sequence->stop_is_over());
}

// Some of its steps were sent, and the rest will not be: what might still come of them is withdrawn, as it is at the
// end of a client's time.
void Axis::end_begun(Pending& pending) {
  pending.command_sequence->expire();
  complete(pending.id, pending.command_sequence->result());
}

}  // namespace axisgate::drive
