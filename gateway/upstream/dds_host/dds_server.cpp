// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_host/dds_server.hpp"

#include <utility>

#include "gateway/upstream/dds_host/dds_program.hpp"

namespace axisgate::dds {
namespace {

/// Of a client, as it wrote it; others say who is there.
bool is_sample(const Record& record) {
  return std::holds_alternative<CommandRecord>(record) || std::holds_alternative<ObjectRequestRecord>(record) ||
         std::holds_alternative<HeartbeatRecord>(record) || std::holds_alternative<JointCommandsRecord>(record) ||
         std::holds_alternative<RosActionRecord>(record);
}

}  // namespace

DdsServer::DdsServer(boost::asio::io_context& io, Runtime& runtime, const DdsSettings& settings, ProcessImage& image,
                     const EventRing& events, CommandPort& commands, const Log& log, DdsReports reports)
    : runtime_(runtime),
      settings_(settings),
      log_(log),
      reports_(std::move(reports)),
      keeper_(io, runtime, kProgram, *this, log, reports_.process),
      session_(settings, image, events, commands, [this] { keeper_.wake(); },
               {[this](const std::string& line) { log_.write(LogLevel::info, "dds", host::printable(line)); },
                [this](bool taken, const std::string& where) { on_name_taken(taken, where); },
                [this](const std::string& line) {
                  log_.write(LogLevel::info, "dds", host::printable(line), LogPace::each);  // that of each writer
                }}) {}

DdsServer::~DdsServer() { keeper_.stop(); }

void DdsServer::start() { keeper_.run(serve_arguments(settings_, host::kLinkDescriptor)); }

host::Heard DdsServer::hear(Bytes packet) {
  Decoded decoded = decode(packet);
  host::Heard heard = host::heard<ReadyRecord, LogRecord>(decoded, kProgram.name);
  if (heard.what == host::Heard::What::own) heard_ = std::move(decoded.record);
  return heard;
}

void DdsServer::take(Instant now) {
  if (is_sample(heard_)) ++counts_.received;
  session_.on_record(heard_, now);
}

std::optional<std::vector<Byte>> DdsServer::next(Instant now) {
  const auto record = session_.next(now);
  if (!record) return std::nullopt;
  ++counts_.sent;
  return encode(*record);
}

void DdsServer::on_name_taken(bool taken, const std::string& where) {
  if (reports_.name_taken) reports_.name_taken(taken);
  const std::string name = "the gateway name \"" + settings_.gateway.name + "\" ";
  if (!taken)
    return reports_.process.event(EventKind::warning, name + "is ours alone again: DDS clients may start axes");
  reports_.process.event(EventKind::warning,
                         name + "is taken in this domain as well (" + host::printable(where) +
                             "): DDS clients start nothing until it is not; give each gateway a \"gateway\": "
                             "{\"name\": ...} of its own");
}

}  // namespace axisgate::dds
