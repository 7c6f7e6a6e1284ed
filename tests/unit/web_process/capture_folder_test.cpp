// SPDX-License-Identifier: Apache-2.0
// Captures as files: what is written is read back, and nothing that lies in a folder, or is wrong with it, ends
// anything.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "gateway/upstream/web_process/capture/capture_file.hpp"
#include "gateway/upstream/web_process/serve/capture_folder.hpp"
#include "tests/unit/web_process/capture_stage.hpp"

namespace axisgate::web {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::size_t kMost = std::size_t{16} << 20;

/// Of one fault of axis 1 in motion.
Recorder::Kept a_capture(std::uint16_t axis = 1) {
  CaptureStage stage;
  stage.run(2 * kSecond);
  stage.event(axis, EventKind::command, 3, "10.0.0.1: run_velocity");
  stage.fault(axis);
  stage.run(6 * kSecond);
  return stage.completed.front();
}

TEST(CaptureFile, IsReadBackAsItWasWritten) {
  const Recorder::Kept written = a_capture();
  const auto read = capture_of(file_of(*written));
  ASSERT_TRUE(std::holds_alternative<Capture>(read)) << std::get<std::string>(read);
  const Capture& capture = std::get<Capture>(read);
  EXPECT_EQ(capture.id, written->id);
  EXPECT_EQ(capture.from, written->from);
  EXPECT_EQ(capture.to, written->to);
  EXPECT_EQ(capture.to_utc, written->to_utc);
  EXPECT_EQ(capture.times, written->times);
  EXPECT_TRUE(capture.complete);
  EXPECT_EQ(capture.causes, written->causes);
  EXPECT_EQ(capture.events, written->events);
  EXPECT_EQ(capture.find(2)->name, "axis 2");
  ASSERT_EQ(capture.lines.size(), written->lines.size());
  EXPECT_EQ(capture.samples(), written->samples());
  for (const Quantity quantity : {Quantity::velocity_actual, Quantity::position_actual})
    for (const std::uint16_t axis : {std::uint16_t{1}, std::uint16_t{2}})
      EXPECT_EQ(CaptureStage::points(capture, axis, quantity), CaptureStage::points(*written, axis, quantity));
}

TEST(CaptureFile, IsRefusedWhereItIsNotWholeOrOfAnotherVersion) {
  const std::vector<Byte> good = file_of(*a_capture());
  const auto why = [](std::vector<Byte> bytes) {
    const auto read = capture_of(bytes);
    const auto* text = std::get_if<std::string>(&read);
    return text == nullptr ? "" : *text;
  };
  EXPECT_EQ(why(good), "");
  for (std::size_t size = 0; size < good.size(); size += 1 + size / 50)
    EXPECT_NE(why({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  std::vector<Byte> longer = good;
  longer.push_back(0);
  EXPECT_EQ(why(longer), "it is not whole");
  std::vector<Byte> other = good;
  other[std::string_view("axisgate capture\n").size()] = 2;
  EXPECT_EQ(why(other), "it is of another version of axisgate");
  EXPECT_EQ(why({'{', '}'}), "it is no capture");
  // Whatever a byte becomes, it is a capture or it is refused.
  for (std::size_t at = 0; at < good.size(); at += 1 + good.size() / 2000)
    for (const Byte flip : {Byte{0x01}, Byte{0x80}, Byte{0xFF}}) {
      std::vector<Byte> bad = good;
      bad[at] ^= flip;
      const auto read = capture_of(bad);
      const auto* capture = std::get_if<Capture>(&read);
      if (capture == nullptr) continue;
      std::size_t visited = 0;
      for (const auto& [series, points] : capture->lines)
        capture->each(series, capture->from - 1, capture->to, [&](const Point&) { return ++visited != 0; });
      EXPECT_LE(visited, capture->samples());
    }
}

TEST(PackedPoints, KeepValuesGapsAndTheEndOfWhatStands) {
  PackedPoints packed;
  const std::vector<Point> points{{1000, -5, true},
                                  {3000, -5, true},
                                  {5000, 0, false},
                                  {7000, -5, true},
                                  {8000, 4'294'967'295, true},
                                  {9000, -2'147'483'648, true},
                                  {900'000'000, 0, true}};
  for (const Point& point : points) packed.add(point);
  packed.add({8000, 1, true});  // older
  packed.add({900'000'000'000, 0, true});
  packed.add({900'000'001'000, 0, true});
  const auto all = [](const PackedPoints& of, SteadyNs from, SteadyNs to) {
    std::vector<Point> out;
    of.each(from, to, [&](const Point& point) {
      out.push_back(point);
      return true;
    });
    return out;
  };
  auto expected = points;
  expected.push_back({900'000'001'000, 0, true});
  EXPECT_EQ(all(packed, 0, INT64_MAX), expected);
  const auto again = PackedPoints::unpacked(packed.packed(), 0, 900'000'001'000);
  ASSERT_TRUE(again);
  EXPECT_EQ(all(*again, 0, INT64_MAX), expected);
  EXPECT_THAT(all(packed, 4000, 5000), ElementsAre(Point{4000, -5, true}, Point{5000, 0, false}));
  EXPECT_THAT(all(packed, 6000, 6500), ElementsAre(Point{6000, 0, false})) << "what held, and no more";
  EXPECT_FALSE(PackedPoints::unpacked(packed.packed(), 0, 9000)) << "of another time than its capture's";
  EXPECT_FALSE(PackedPoints::unpacked("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 0, INT64_MAX / 2));
}

TEST(PackedPoints, ThinnedHaveTheLowestTheHighestAndWhatStandsBehind) {
  PackedPoints packed;
  Thinned thin(packed);
  constexpr SteadyNs kAt = 1000 * kSecond;  // where a slice begins
  SteadyNs at = kAt;
  for (const std::int64_t value : {5, 6, 100, -7, 6, 3}) thin.add({at += kMillisecond, value, true});
  thin.flush();
  std::vector<Point> points;
  packed.each(kAt, kAt + kSecond, [&](const Point& point) {
    points.push_back(point);
    return true;
  });
  EXPECT_THAT(points, ElementsAre(Point{kAt + 3 * kMillisecond, 100, true}, Point{kAt + 4 * kMillisecond, -7, true},
                                  Point{at, 3, true}));
}

class Folder : public ::testing::Test {
 protected:
  Folder() : path(fs::path(::testing::TempDir()) / ("captures." + std::to_string(getpid()))) { fs::remove_all(path); }
  ~Folder() override { fs::remove_all(path); }

  CaptureFolder open() { return open(path.string()); }
  CaptureFolder open(const std::string& at) {
    return CaptureFolder(at, [this](LogLevel, const std::string& line) { lines.push_back(line); });
  }
  /// Ids of what a program that starts finds.
  std::vector<std::string> found(CaptureSettings settings = {}) {
    CaptureFolder folder = open();
    Recorder recorder(std::move(settings), kMost);
    folder.restore(recorder, kMost);
    std::vector<std::string> out;
    for (const Recorder::Kept& each : recorder.all()) out.push_back(each->id);
    return out;
  }
  void write(const std::string& name, const std::string& content) { std::ofstream(path / name) << content; }
  std::string only_line() {
    EXPECT_THAT(lines, SizeIs(1));
    return lines.empty() ? "" : lines.front();
  }

  const fs::path path;
  std::vector<std::string> lines;
};

TEST_F(Folder, HasAFileOfEachCaptureAndLosesItWithIt) {
  const Recorder::Kept one = a_capture();
  open().take({{one}, {}});
  struct stat status {};
  ASSERT_EQ(stat((path / (one->id + ".capture")).c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640U);
  EXPECT_THAT(found(), ElementsAre(one->id));
  open().take({{}, {one->id, "42.9"}});
  EXPECT_THAT(found(), IsEmpty());
  EXPECT_TRUE(fs::is_empty(path));
  EXPECT_THAT(lines, IsEmpty());
}

TEST_F(Folder, LeavesAloneWhatIsNoCaptureAndNamesIt) {
  const Recorder::Kept one = a_capture();
  open().take({{one}, {}});
  const std::vector<Byte> good = file_of(*one);
  write("1.1.capture", std::string(good.begin(), good.begin() + 1000));
  write("1.2.capture", "");
  write("1.3.capture", std::string(good.begin(), good.end()));  // a copy under another name
  write("notes.txt", "somebody's own");
  fs::create_directory(path / "1.4.capture");
  mkfifo((path / "1.5.capture").c_str(), 0600);
  fs::create_symlink("/etc/passwd", path / "1.6.capture");
  EXPECT_THAT(found(), ElementsAre(one->id));
  EXPECT_THAT(only_line(), HasSubstr("these are no captures, and are left alone: "));
  EXPECT_THAT(only_line(), HasSubstr(" and 3 more"));
  for (const char* name : {"1.1.capture", "1.2.capture", "1.3.capture", "1.4.capture", "notes.txt"})
    EXPECT_TRUE(fs::exists(path / name)) << name;
}

TEST_F(Folder, RemovesWhatWasHalfWritten) {
  open();
  write("42.7.part", "half");
  EXPECT_THAT(found(), IsEmpty());
  EXPECT_TRUE(fs::is_empty(path));
}

TEST_F(Folder, KeepsNoMoreThanItMayAfterAStart) {
  const Recorder::Kept one = a_capture(1), two = a_capture(2);
  ASSERT_NE(one->id, "");
  auto later = std::make_shared<Capture>(*two);
  later->id = "43.1";
  later->to_utc += kSecond;
  open().take({{one, later}, {}});
  CaptureSettings settings;
  settings.keep = 1;
  EXPECT_THAT(found(settings), ElementsAre("43.1")) << "the newest by the time of day, whichever gateway it was";
}

TEST_F(Folder, ThatIsNotThereOrCannotBeWrittenIsNamedAndEndsNothing) {
  const Recorder::Kept one = a_capture();
  CaptureFolder missing = open((path / "a" / "b").string());
  EXPECT_EQ(missing.descriptor(), -1);
  missing.take({{one}, {"42.1"}});
  EXPECT_THAT(only_line(), HasSubstr("captures are in memory alone: "));
  EXPECT_THAT(only_line(), HasSubstr("No such file or directory"));
  lines.clear();
  fs::create_directory(path);
  write("file", "");
  EXPECT_EQ(open((path / "file").string()).descriptor(), -1);
  EXPECT_THAT(only_line(), HasSubstr("Not a directory"));
}

TEST_F(Folder, SaysOnceThatItCannotWriteAndOnceThatItCanAgain) {
  CaptureFolder folder = open();
  const Recorder::Kept one = a_capture();
  fs::remove(path);  // somebody has taken it away
  folder.take({{one}, {}});
  folder.take({{one}, {}});
  EXPECT_THAT(only_line(), HasSubstr("capture " + one->id + " is in memory alone: it cannot be written to "));
}

TEST_F(Folder, OnAFullDiskHasNoHalfFile) {
  CaptureFolder folder = open();
  // The file's name is taken by what cannot be replaced: the last step fails, as on a full disk.
  const Recorder::Kept one = a_capture();
  fs::create_directories(path / (one->id + ".capture") / "x");
  folder.take({{one}, {}});
  EXPECT_THAT(only_line(), HasSubstr("cannot be written"));
  EXPECT_FALSE(fs::exists(path / (one->id + ".part")));
  lines.clear();
  fs::remove_all(path / (one->id + ".capture"));
  folder.take({{one}, {}});
  EXPECT_THAT(only_line(), HasSubstr("are written to"));
}

}  // namespace
}  // namespace axisgate::web
