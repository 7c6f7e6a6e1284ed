// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/session/object_run.hpp"

#include <utility>

namespace axisgate::modbus_tcp {

std::optional<BatchResult> ObjectRun::start(CommandPort& commands, const WriteBatch& batch, OnDone on_done) {
  on_done_ = std::move(on_done);
  // The callback holds the run: a refusal is recorded even when the session that asked is gone.
  auto at_once = commands.submit(axis_, batch, [self = shared_from_this()](const BatchResult& result) {
    self->record(result);
    // Moved out first: whoever is told may let go of this run.
    if (self->on_done_) std::exchange(self->on_done_, nullptr)(result);
  });
  if (at_once) record(*at_once);
  return at_once;
}

/// The reply carries an abort code, whatever the drive speaks; what it said itself is told here. Other ends are told by
/// the reply alone, and a command under way keeps its registers.
void ObjectRun::record(const BatchResult& result) const {
  const std::shared_ptr<Client> client = client_.lock();
  if (client == nullptr || result.outcome.code != Errc::refused_by_drive) return;
  ClientAxis& own = client->at(axis_);
  own.used = true;
  own.result.detail = result.outcome.detail;
  if (own.result.result != CommandResult::pending) own.result.result = command_result(result.outcome.code);
}

}  // namespace axisgate::modbus_tcp
