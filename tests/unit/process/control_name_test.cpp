// SPDX-License-Identifier: Apache-2.0
// Where `axisgate reload` finds a gateway: every path of a configuration gives a name that a socket can have.
#include <gtest/gtest.h>

#include <boost/asio/local/stream_protocol.hpp>
#include <string>

#include "gateway/process/control_socket.hpp"

namespace axisgate::process {
namespace {

std::string path_of(std::size_t length, char first = 'a') {
  return std::string("/") + first + std::string(length - 2, 'x');
}

TEST(ControlName, OfAnyPathFitsASocket) {
  for (const std::size_t length : {2U, 96U, 97U, 98U, 99U, 106U, 107U, 108U, 109U, 4000U})
    EXPECT_NO_THROW(boost::asio::local::stream_protocol::endpoint('\0' + control_name(path_of(length)))) << length;
}

TEST(ControlName, IsThePathWhereThatFits) {
  EXPECT_EQ(control_name("/etc/axisgate/../axisgate/gateway.json"), "axisgate//etc/axisgate/gateway.json");
  EXPECT_EQ(control_name(path_of(97)), "axisgate/" + path_of(97));
}

TEST(ControlName, OfTwoLongPathsWithTheSameEndingIsNotTheSame) {
  EXPECT_NE(control_name(path_of(98, 'a')), control_name(path_of(98, 'b')));
  EXPECT_NE(control_name(path_of(300)), control_name(path_of(301)));
  EXPECT_EQ(control_name(path_of(300)), control_name(path_of(300)));
}

}  // namespace
}  // namespace axisgate::process
