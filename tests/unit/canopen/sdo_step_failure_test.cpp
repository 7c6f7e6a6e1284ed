// SPDX-License-Identifier: Apache-2.0
// Every transfer, with every one of its replies failing in every way: silence, abort, wrong toggle, wrong object,
// another node's, too late, twice, and the drive restarting in its midst.
#include "tests/unit/canopen/sdo_stage.hpp"

namespace axisgate::test {
namespace {

using Result = std::optional<bus::ExchangeResult>;

struct Transfer {
  const char* name;
  bool write;
  std::size_t size;
  bool blocks;
};
void PrintTo(const Transfer& c, std::ostream* out) { *out << c.name; }

class SdoStepFailure : public SdoStage, public testing::WithParamInterface<Transfer> {
 protected:
  void SetUp() override { fresh(); }
  void fresh() {
    server = SdoServer{};
    server.objects[kObject] = content_of(GetParam().write ? 3 : GetParam().size);
    server.offers_block = GetParam().blocks;
    begin({.name = "can0", .nodes = {{.node = 1, .sdo_block = GetParam().blocks}, {.node = 2}}});
    served = 0;
    replies_sent = 0;
    spoil = nullptr;
  }
  [[nodiscard]] bus::Exchange what() const {
    return GetParam().write ? long_write_of(kObject, content_of(GetParam().size)) : long_read_of(kObject);
  }
  /// Runs the transfer once for each of its replies, that one spoiled: `how` may change it; false: it is lost.
  /// In blocks a lost segment is repeated, and nobody notices: that is no silence.
  template <typename How, typename Check>
  void with_each_reply(How how, Check check) {
    ASSERT_EQ(transfer(what())->code, Errc::ok);
    const int count = replies_sent;
    for (int spoiled = 1; spoiled <= count; ++spoiled) {
      SCOPED_TRACE("reply " + std::to_string(spoiled) + " of " + std::to_string(count));
      fresh();
      spoil = [&](ByteRow& row) { return replies_sent != spoiled || how(row); };
      check(transfer(what()));
    }
  }
  template <typename How>
  void expect_silence_at_each_reply(How how) {
    with_each_reply(how, [&](const Result& result) {
      if (GetParam().blocks && result) return;
      expect_silence_then_recovery(result);
    });
  }
  void expect_whole(const Result& result) {
    ASSERT_TRUE(result);
    EXPECT_EQ(result->code, Errc::ok);
    if (!GetParam().write && result->bytes) {
      EXPECT_EQ(*result->bytes, content_of(GetParam().size));
    }
    if (GetParam().write) {
      EXPECT_EQ(server.objects[kObject], content_of(GetParam().size));
    }
  }
  /// After whatever went wrong: the same again must go well.
  void expect_recovery() {
    spoil = nullptr;
    expect_whole(transfer(what()));
  }
  /// Silence: the bus gives up at its timeout.
  void expect_silence_then_recovery(const Result& result) {
    ASSERT_FALSE(result) << "nothing may end the exchange but its timeout";
    wire->abandon();
    serve();
    EXPECT_TRUE(server.idle()) << "the server knows that the transfer is over";
    EXPECT_THAT(server.aborts_heard, testing::ElementsAre(0x05040000u));
    expect_recovery();
  }
};

TEST_P(SdoStepFailure, a_lost_reply_ends_by_the_timeout_and_an_abort) {
  expect_silence_at_each_reply([](ByteRow&) { return false; });
}

TEST_P(SdoStepFailure, a_wrong_toggle_or_sub_index_is_not_taken) {
  if (GetParam().blocks) return;  // no toggles there: sequences have their own tests
  expect_silence_at_each_reply([](ByteRow& row) {
    const bool names_object = (row[0] & 0xE0) == 0x40 || (row[0] & 0xE0) == 0x60;
    row[names_object ? 3 : 0] ^= names_object ? 1 : 0x10;
    return true;
  });
}

TEST_P(SdoStepFailure, an_abort_ends_it_with_the_servers_code) {
  with_each_reply(
      [](ByteRow& row) {
        row = from_hex("80 00 20 00 21 00 00 08");
        return true;
      },
      [&](const Result& result) {
        EXPECT_EQ(result, refusal_of(0x08000021, true));
        fresh();
        expect_recovery();
      });
}

TEST_P(SdoStepFailure, a_reply_that_comes_after_the_timeout_ends_nothing) {
  std::optional<ByteRow> late;
  with_each_reply(
      [&](ByteRow& row) {
        late = row;
        return false;
      },
      [&](const Result& result) {
        if (result) return;
        wire->abandon();
        const std::size_t before = replies.size();
        bring(can::data_frame(0x581, *late));
        wire->send(read_of(0x6041));
        bring(can::data_frame(0x581, *late));
        EXPECT_EQ(replies.size(), before);
      });
}

TEST_P(SdoStepFailure, a_restart_in_its_midst_is_told_and_the_transfer_forgotten) {
  with_each_reply(
      [&](ByteRow&) {
        SdoServer restarted;
        restarted.offers_block = server.offers_block;
        restarted.objects = server.objects;
        server = restarted;
        bring(0x701, "00");
        return false;
      },
      [&](const Result& result) {
        EXPECT_THAT(kinds(), testing::ElementsAre(bus::UnsolicitedEvent::Kind::started));
        if (result) return;
        const std::size_t sent = link->sent.size();
        wire->abandon();
        EXPECT_EQ(link->sent.size(), sent) << "there is nothing to abort in a node that has just started";
        expect_recovery();
      });
}

TEST_P(SdoStepFailure, a_link_loss_in_its_midst_leaves_nothing_behind) {
  with_each_reply([](ByteRow&) { return false; },
                  [&](const Result& result) {
                    if (result) return;
                    link->events->on_link_down("can0 is gone");
                    link->events->on_link_up();
                    const std::size_t before = replies.size();
                    wire->send(read_of(0x6041));
                    EXPECT_EQ(replies.size(), before);
                    EXPECT_EQ(link->sent.back(), frame_of(0x601, "40 41 60 00 00 00 00 00")) << "no abort either";
                  });
}

INSTANTIATE_TEST_SUITE_P(
    All, SdoStepFailure,
    testing::Values(Transfer{"expedited_read", false, 4, false}, Transfer{"expedited_write", true, 2, false},
                    Transfer{"segmented_read", false, 20, false}, Transfer{"segmented_write", true, 20, false},
                    Transfer{"block_read", false, 200, true}, Transfer{"block_write", true, 200, true}),
    [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace axisgate::test
