// SPDX-License-Identifier: Apache-2.0
// Property: the answer is found after any noise that does not itself contain a full answer, however the bytes are cut.
// Noise is drawn to be nasty: pieces of true frames, well-summed strangers, echoes, and bytes chosen so that a window
// across the start of the answer adds up to 0.
#include "adapters/kinco/kinco_receiver.hpp"
#include "gateway/core/random.hpp"
#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::kinco {
namespace {

using test::ByteRow;

class Scene {
 public:
  explicit Scene(std::uint64_t seed) : random_(seed) {
    exchange_ = random_.chance(1, 2) ? test::read_of(any_index(), 0, 0, station())
                                     : test::write_of(any_index(), any_data(), 2, station());
    reply_ = test::row(encode(answer()));
    const std::uint64_t pieces = random_.below(4);
    for (std::uint64_t i = 0; i < pieces; ++i) add_piece();
    if (random_.chance(1, 3)) make_straddle();
  }

  [[nodiscard]] const bus::Exchange& exchange() const { return exchange_; }
  [[nodiscard]] ByteRow stream() const {
    using test::operator+;
    return noise_ + reply_;
  }
  /// Where the answer ends that a patient reader with the whole stream before him finds first.
  [[nodiscard]] std::size_t first_answer_end() const {
    const ByteRow all = stream();
    for (std::size_t at = 0; at + kFrameSize <= all.size(); ++at) {
      const Decoded decoded = decode(Bytes(all).subspan(at));
      const Frame* frame = std::get_if<Frame>(&decoded);
      if (frame != nullptr && answers(*frame, exchange_)) return at + kFrameSize;
    }
    return 0;
  }

 private:
  std::uint16_t any_index() { return static_cast<std::uint16_t>(0x6040 + random_.below(4)); }
  std::uint8_t station() { return static_cast<std::uint8_t>(1 + random_.below(2)); }
  std::uint32_t any_data() { return static_cast<std::uint32_t>(random_.next()); }
  Frame answer() {
    static constexpr std::array kReplies{Command::value_1, Command::value_2, Command::value_4, Command::error};
    const Command command = exchange_.access == bus::Access::read ? kReplies.at(random_.below(4))
                            : random_.chance(1, 4)                ? Command::error
                                                                  : Command::written;
    return {.node = exchange_.node, .command = command, .object = exchange_.object, .data = any_data()};
  }
  void append(const ByteRow& bytes) { noise_.insert(noise_.end(), bytes.begin(), bytes.end()); }
  ByteRow part_of(const ByteRow& bytes) {
    const std::uint64_t from = random_.below(bytes.size());
    const std::uint64_t to = from + random_.below(bytes.size() - from + 1);
    return {bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.begin() + static_cast<std::ptrdiff_t>(to)};
  }
  ByteRow stranger() {
    Frame frame = answer();
    if (random_.chance(1, 2)) frame.node = static_cast<std::uint8_t>(frame.node ^ 3);
    if (random_.chance(1, 2)) frame.object.index = any_index();
    if (random_.chance(1, 2)) frame.command = random_.chance(1, 2) ? Command::read : Command::written;
    return test::row(encode(frame));
  }
  void add_piece() {
    switch (random_.below(5)) {
      case 0:
        for (std::uint64_t i = random_.below(15); i > 0; --i) noise_.push_back(static_cast<Byte>(random_.below(256)));
        break;
      case 1:
        append(part_of(reply_));
        break;
      case 2:
        append(stranger());
        break;
      case 3:
        append(part_of(stranger()));
        break;
      default:
        append(test::row(encode(request_of(exchange_))));
        break;
    }
  }
  /// A head of noise that makes a plausible frame together with the first bytes of the answer.
  void make_straddle() {
    const std::size_t borrowed = 1 + random_.below(7);
    ByteRow head{static_cast<Byte>(random_.below(256)), 0x43};
    while (head.size() + borrowed < kFrameSize) head.push_back(static_cast<Byte>(random_.below(256)));
    int sum = 0;
    for (std::size_t i = 0; i + 1 < head.size(); ++i) sum += head[i];
    for (std::size_t i = 0; i < borrowed; ++i) sum += reply_[i];
    if (head.size() > 2) head.back() = static_cast<Byte>(-sum);
    append(head);
  }

  Random random_;
  bus::Exchange exchange_;
  ByteRow noise_;
  ByteRow reply_;
};

TEST(KincoReceiverProperty, the_first_full_answer_is_heard_after_any_noise) {
  std::uint64_t behind_noise = 0;
  for (std::uint64_t seed = 1; seed <= 50'000; ++seed) {
    const Scene scene(seed);
    const ByteRow stream = scene.stream();
    Receiver receiver;
    receiver.await(scene.exchange());
    std::size_t heard_at = 0;
    for (std::size_t i = 0; i < stream.size() && heard_at == 0; ++i) {
      if (receiver.take(stream[i]) == Receiver::Heard::answer) heard_at = i + 1;
    }
    ASSERT_EQ(heard_at, scene.first_answer_end()) << "seed " << seed << ": " << hex_text(stream);
    if (heard_at == stream.size() && stream.size() > kFrameSize) ++behind_noise;
  }
  EXPECT_GT(behind_noise, 30'000u) << "most scenes must be about noise before the true answer";
}

TEST(KincoReceiverProperty, every_byte_is_accounted_for) {
  for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
    const Scene scene(seed);
    const ByteRow stream = scene.stream();
    Receiver receiver;
    receiver.await(scene.exchange());
    std::size_t frames = 0;
    for (const Byte byte : stream) {
      if (receiver.take(byte) != Receiver::Heard::nothing) ++frames;
    }
    receiver.reset();
    // A stranger that borrowed bytes of the answer shares them with it, so frames may explain more than there were.
    ASSERT_LE(receiver.dropped_bytes(), stream.size()) << "seed " << seed;
    ASSERT_GE(receiver.dropped_bytes() + frames * kFrameSize, stream.size()) << "seed " << seed;
  }
}

TEST(KincoReceiverProperty, no_noise_alone_is_an_answer) {
  Random random(7);
  Receiver receiver;
  receiver.await(test::read_of(0x6041));
  for (int i = 0; i < 2'000'000; ++i) {
    ASSERT_NE(receiver.take(static_cast<Byte>(random.below(256))), Receiver::Heard::answer);
  }
}

}  // namespace
}  // namespace axisgate::kinco
