// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/support/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/beast/zlib/deflate_stream.hpp>
#include <boost/crc.hpp>
#include <numeric>

namespace axisgate::commands::support {
namespace {

constexpr std::size_t kBlock = 512;
constexpr std::size_t kChecksumAt = 148, kChecksumSize = 8;

std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

/// One regular file that its owner alone reads.
std::string header_of(const ArchivedFile& file, std::uint64_t seconds) {
  const std::string name = padded(file.name.substr(0, kLongestName), kLongestName);
  std::string out = name + padded("0000600", 8) + padded("0000000", 8) + padded("0000000", 8) +
                    padded(fmt::format("{:011o}", file.text.size()), 12) + padded(fmt::format("{:011o}", seconds), 12) +
                    std::string(kChecksumSize, ' ') + "0" + std::string(kLongestName, '\0') +
                    std::string("ustar\0", 6) + "00";
  out.resize(kBlock, '\0');
  const auto sum = std::accumulate(out.begin(), out.end(), 0U,
                                   [](unsigned so_far, char c) { return so_far + static_cast<unsigned char>(c); });
  out.replace(kChecksumAt, kChecksumSize, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
  return out;
}

std::string little_endian(std::uint32_t number) {
  std::string out;
  for (unsigned shift = 0; shift < 32; shift += 8) out += static_cast<char>((number >> shift) & 0xFFU);
  return out;
}

}  // namespace

std::string tar_of(const std::vector<ArchivedFile>& files, std::uint64_t seconds) {
  std::string out;
  for (const ArchivedFile& file : files) {
    out += header_of(file, seconds) + file.text;
    out.resize((out.size() + kBlock - 1) / kBlock * kBlock, '\0');
  }
  return out + std::string(2 * kBlock, '\0');
}

std::string gzip_of(std::string_view bytes) {
  namespace zlib = boost::beast::zlib;
  std::string deflated(zlib::deflate_upper_bound(bytes.size()), '\0');
  zlib::deflate_stream stream;
  zlib::z_params work{};
  work.next_in = bytes.data();
  work.avail_in = bytes.size();
  work.next_out = deflated.data();
  work.avail_out = deflated.size();
  boost::system::error_code end;  // that of the stream: all has room
  stream.write(work, zlib::Flush::finish, end);
  deflated.resize(work.total_out);
  boost::crc_32_type sum;
  sum.process_bytes(bytes.data(), bytes.size());
  // Deflate, no name, no time, of Unix.
  const std::string head("\x1f\x8b\x08\0\0\0\0\0\0\x03", 10);
  return head + deflated + little_endian(sum.checksum()) + little_endian(static_cast<std::uint32_t>(bytes.size()));
}

}  // namespace axisgate::commands::support
