// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/capture/capture_file.hpp"

#include <limits>

#include "gateway/core/numbers.hpp"
#include "gateway/upstream/link/coder.hpp"

namespace axisgate::web {
namespace {

/// Another one where the members are others.
constexpr std::uint8_t kVersion = 1;
constexpr std::string_view kMagic = "axisgate capture\n";
constexpr std::size_t kPiece = 32 * 1024;
/// Of one line: more than any capture has.
constexpr std::size_t kMostPieces = 8 * 1024;
/// No clock of a computer counts so far: sums of two stay numbers.
constexpr std::int64_t kMostNs = std::numeric_limits<std::int64_t>::max() / 4;

/// A line by its name: what stands at a place in the table may be another one in another version.
struct LineInFile {
  std::uint16_t axis = 0;
  std::string name;
  std::vector<std::string> pieces;
};

/// All but the lines.
template <typename Coder, typename C>
void head(Coder& coder, C& capture) {
  coder.text(capture.id, kMaxName);
  coder(capture.from, capture.to, capture.to_utc, capture.cut, capture.times);
  coder.list(capture.causes, kMostCauses, [&](auto& cause) {
    coder(cause.cause, cause.axis, cause.at);
    coder.text(cause.text, kMaxText);
  });
  coder.list(capture.axes, kMaxAxisNumber, [&](auto& axis) {
    coder(axis.axis, axis.units_numerator, axis.units_denominator);
    coder.text(axis.name, kMaxName);
    coder.text(axis.profile, kMaxName);
  });
  coder.list(capture.events, kMostEvents, [&](auto& event) {
    coder(event.number, event.at, event.axis, event.kind, event.code);
    coder.text(event.text, kMaxText);
  });
}

template <typename Coder, typename Line>
void line_of(Coder& coder, Line& line) {
  coder(line.axis);
  coder.text(line.name, kMaxName);
  coder.list(line.pieces, kMostPieces, [&](auto& piece) { coder.text(piece, kPiece); });
}

std::vector<std::string> pieces_of(const std::string& whole) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < whole.size(); at += kPiece) out.push_back(whole.substr(at, kPiece));
  return out;
}

std::string whole_of(const std::vector<std::string>& pieces) {
  std::string out;
  for (const std::string& piece : pieces) out += piece;
  return out;
}

bool is_instant(std::int64_t at) { return at >= 0 && at <= kMostNs; }

/// What the rest of the program takes for granted of a capture.
bool holds(const Capture& capture) {
  bool good = is_capture_id(capture.id) && is_instant(capture.from) && is_instant(capture.to) &&
              capture.from <= capture.to && is_instant(capture.to_utc) && !capture.causes.empty();
  for (const CauseSeen& cause : capture.causes) good = good && is_instant(cause.at);
  for (const EventRecord& event : capture.events) good = good && is_instant(event.at);
  for (const AxisInfoRecord& axis : capture.axes) good = good && axis.units_numerator > 0 && axis.units_denominator > 0;
  return good;
}

/// False: it is no line of this capture.
bool take(const LineInFile& line, Capture& capture) {
  const auto name = series_named(line.name);
  if (!name) return true;  // of an axisgate that knows more
  auto points = PackedPoints::unpacked(whole_of(line.pieces), capture.from, capture.to);
  if (!points || capture.find(line.axis) == nullptr) return false;
  capture.lines.emplace(Series{line.axis, *name}, std::move(*points));
  return true;
}

}  // namespace

std::vector<Byte> file_of(const Capture& capture) {
  std::vector<Byte> bytes(kMagic.begin(), kMagic.end());
  bytes.reserve(capture.bytes());
  bytes.push_back(kVersion);
  link::Encoder encoder(bytes);
  head(encoder, capture);
  encoder(static_cast<std::uint16_t>(capture.lines.size()));
  for (const auto& [series, points] : capture.lines) {
    const LineInFile line{series.axis, std::string(series_name(series.name)), pieces_of(points.packed())};
    line_of(encoder, line);
  }
  return bytes;
}

std::variant<Capture, std::string> capture_of(Bytes file) {
  const bool magic = file.size() > kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), file.begin());
  if (!magic) return "it is no capture";
  if (file[kMagic.size()] != kVersion) return "it is of another version of axisgate";
  link::Decoder decoder(file.subspan(kMagic.size() + 1));
  Capture out;
  head(decoder, out);
  std::uint16_t lines = 0;
  decoder(lines);
  if (!holds(out)) return "it is damaged";
  for (; lines > 0; --lines) {
    LineInFile line;
    line_of(decoder, line);
    if (!take(line, out)) return "it is damaged";
  }
  if (!decoder.complete()) return "it is not whole";
  out.complete = true;
  return out;
}

}  // namespace axisgate::web
