// SPDX-License-Identifier: Apache-2.0
// Properties of the receiver over random streams: what is heard as an answer was asked for, stood in the stream as it
// is told, and began after the request; nothing gets lost uncounted; the cut of the stream changes nothing.
#include <algorithm>

#include "adapters/keya/keya_serial_receiver.hpp"
#include "gateway/core/random.hpp"
#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::keya {
namespace {

using test::ByteRow;
using test::operator+;
using Heard = SerialReceiver::Heard;

class Scene {
 public:
  explicit Scene(std::uint64_t seed) : random_(seed) {
    line_ = random_.chance(1, 2) ? KeyaLine::rs232 : KeyaLine::rs485;
    query_ = test::read_of(static_cast<std::uint16_t>(kQueryIndex + code()), 0, 0, 0, node());
    if (random_.chance(1, 3)) add_piece();
    asked_ = stream_.size() - random_.below(stream_.size() + 1);
    for (std::uint64_t i = random_.below(4); i > 0; --i) add_piece();
    SerialFrame answer = any_answer();
    answer.code = static_cast<std::uint8_t>(query_.object.index - kQueryIndex);
    if (line_ == KeyaLine::rs485) answer.node = query_.node;
    answer_ = test::row(encode(line_, answer));
    if (random_.chance(4, 5)) append(answer_);
    for (std::uint64_t i = random_.below(3); i > 0; --i) add_piece();
  }

  [[nodiscard]] KeyaLine line() const { return line_; }
  [[nodiscard]] const bus::Exchange& query() const { return query_; }
  [[nodiscard]] const ByteRow& stream() const { return stream_; }
  [[nodiscard]] const ByteRow& answer() const { return answer_; }
  /// Bytes of the stream that come before the request.
  [[nodiscard]] std::size_t asked() const { return asked_; }

 private:
  std::uint8_t code() { return static_cast<std::uint8_t>(random_.below(kQueries)); }
  std::uint8_t node() { return static_cast<std::uint8_t>(1 + random_.below(2)); }
  void append(const ByteRow& bytes) { stream_ = stream_ + bytes; }
  /// With zeros where the manual prints them, and start bytes in the data more often than by chance.
  SerialFrame any_answer() {
    SerialFrame frame{.start = kQuery, .code = code()};
    if (line_ == KeyaLine::rs485) frame.node = node();
    const std::size_t used = frame.code == 5 ? 1 : frame.code == 8 ? 8 : frame.code == 1 || frame.code == 4 ? 10 : 4;
    for (std::size_t i = 0; i < std::min(used, data_size(line_)); ++i) frame.data.at(i) = any_byte();
    return frame;
  }
  Byte any_byte() {
    static constexpr std::array<Byte, 6> kNasty{0xED, 0xEE, 0xE0, 0x00, 0x02, 0x01};
    return random_.chance(1, 3) ? kNasty.at(random_.below(kNasty.size())) : static_cast<Byte>(random_.below(256));
  }
  ByteRow any_frame() {
    SerialFrame frame = any_answer();
    const std::uint64_t kind = random_.below(4);
    if (kind == 0 && line_ == KeyaLine::rs232) {
      frame = {.start = kHeartbeat};
      for (Byte& byte : frame.data) byte = any_byte();
      frame.data[0] = frame.data[6] = static_cast<Byte>(random_.below(3));
    } else if (kind == 1) {
      frame.start = kControl;
      frame.code = static_cast<std::uint8_t>(random_.below(4));
    } else if (kind == 2) {
      return test::row(encode(line_, request_of(line_, query_)));
    }
    ByteRow bytes = test::row(encode(line_, frame));
    if (frame.start == kHeartbeat && random_.chance(1, 2)) bytes.back() = any_byte();
    return bytes;
  }
  void add_piece() {
    ByteRow bytes = any_frame();
    switch (random_.below(4)) {
      case 0:
        for (Byte& byte : bytes) byte = any_byte();
        break;
      case 1:
        bytes.resize(1 + random_.below(11));
        break;
      case 2:
        bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(1 + random_.below(11)));
        break;
      default:
        break;
    }
    append(bytes);
  }

  Random random_;
  KeyaLine line_ = KeyaLine::rs232;
  bus::Exchange query_;
  ByteRow stream_;
  ByteRow answer_;
  std::size_t asked_ = 0;
};

struct Result {
  std::vector<ByteRow> answers;
  std::vector<std::size_t> answered_at;  ///< bytes of the stream taken
  std::size_t frames = 0;
  std::uint32_t dropped = 0;
};

Result play(const Scene& scene) {
  SerialReceiver receiver(scene.line());
  Result result;
  const auto note = [&](Heard heard, std::size_t taken) {
    if (heard == Heard::nothing) return;
    ++result.frames;
    if (heard != Heard::answer) return;
    result.answers.push_back(test::row(receiver.frame_bytes()));
    result.answered_at.push_back(taken);
  };
  for (std::size_t i = 0; i <= scene.stream().size(); ++i) {
    if (i == scene.asked()) {
      receiver.sent(scene.query(), encode(scene.line(), request_of(scene.line(), scene.query())));
    }
    if (i < scene.stream().size()) note(receiver.take(scene.stream()[i]), i + 1);
  }
  note(receiver.on_silence(), scene.stream().size());
  EXPECT_FALSE(receiver.unfinished());
  result.dropped = receiver.dropped_bytes();
  return result;
}

TEST(KeyaSerialProperty, an_answer_was_asked_for_stood_in_the_stream_and_began_after_the_request) {
  int answered = 0;
  int true_answers = 0;
  for (std::uint64_t seed = 1; seed <= 30'000; ++seed) {
    const Scene scene(seed);
    const Result result = play(scene);
    ASSERT_LE(result.answers.size(), 1u) << "seed " << seed;
    if (result.answers.empty()) continue;
    ++answered;
    const ByteRow& answer = result.answers[0];
    const Decoded decoded = decode(scene.line(), answer);
    ASSERT_TRUE(std::holds_alternative<SerialFrame>(decoded)) << "seed " << seed;
    ASSERT_TRUE(answers(scene.line(), std::get<SerialFrame>(decoded), scene.query())) << "seed " << seed;
    const auto after = scene.stream().begin() + static_cast<std::ptrdiff_t>(scene.asked());
    const auto until = scene.stream().begin() + static_cast<std::ptrdiff_t>(result.answered_at[0]);
    ASSERT_NE(std::search(after, until, answer.begin(), answer.end()), until) << "seed " << seed;
    true_answers += answer == scene.answer() ? 1 : 0;
  }
  EXPECT_GT(answered, 15'000);
  EXPECT_GT(true_answers, answered * 9 / 10);
}

TEST(KeyaSerialProperty, every_byte_is_in_a_frame_or_counted) {
  for (std::uint64_t seed = 1; seed <= 10'000; ++seed) {
    const Scene scene(seed);
    const Result result = play(scene);
    ASSERT_EQ(result.dropped + result.frames * kFrameSize, scene.stream().size()) << "seed " << seed;
  }
}

TEST(KeyaSerialProperty, no_noise_alone_is_an_answer_of_rs485) {
  Random random(7);
  SerialReceiver receiver(KeyaLine::rs485);
  const bus::Exchange query = test::read_of(0x2102);
  receiver.sent(query, encode(KeyaLine::rs485, request_of(KeyaLine::rs485, query)));
  for (int i = 0; i < 1'000'000; ++i) {
    ASSERT_NE(receiver.take(static_cast<Byte>(random.below(256))), Heard::answer);
  }
}

}  // namespace
}  // namespace axisgate::keya
