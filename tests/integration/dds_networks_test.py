# SPDX-License-Identifier: Apache-2.0
"""The ways of docs/dds/networks.md in which programs find the gateway, each as the page has it, with both vendors where both can: two
hosts, static peers, a discovery server, the environment variables of ROS 2, DDS-Security. The second host is a network namespace."""
from own_network import HOST_ADDRESS, OTHER, OTHER_ADDRESS, in_host, make_host, make_interfaces  # first: see there

import subprocess
import sys

from dds_stage import CYCLONE, DONE, FAST, ROLE, DdsStory, Peer, main
from processes import Program, until
from stage import SOURCE

sys.path.insert(0, f"{SOURCE}/tests/docs")
from page_commands import of_page  # noqa: E402

DISCOVERY_PORT = 11811
CYCLONE_PEERS = "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address='{own}'/></Interfaces><AllowMulticast>false" \
    "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>30" \
    "</MaxAutoParticipantIndex><Peers><Peer address='{peer}'/></Peers></Discovery></Domain></CycloneDDS>"
FAST_PEERS = """<?xml version="1.0" encoding="UTF-8"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="peers" is_default_profile="true">
    <rtps>
      <builtin>
        <initialPeersList>
          {locators}
        </initialPeersList>
        <avoid_builtin_multicast>true</avoid_builtin_multicast>
      </builtin>
    </rtps>
  </participant>
</profiles>
"""


def setUpModule():
    make_interfaces()
    make_host()


class Networks(DdsStory):
    lines_of = ("serial",)
    nodes_on_the_host = True
    lives_by = ()

    def setUp(self):
        super().setUp()
        self.prepare()
        self.begin()

    def prepare(self):
        """Before the gateway starts."""

    def node(self, vendor, **environment):
        """A participant as a ROS 2 node makes it, with these environment variables."""
        wrapper = (*(in_host() if self.nodes_on_the_host else ()), "env", *(f"{name}={value}" for name, value in environment.items()))
        node = self.keep(Peer(vendor, self.domain, wrapper, "as_it_comes"))
        node.name = f"{vendor} node {len(self.programs)}"
        return node

    def write_file(self, name, text):
        path = self.path(name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def assert_it_reads_and_commands(self, node):
        node.read("axis_state")
        self.assertEqual(node.sample("axis_state", axis=1)["name"], "serial")
        node.command_with(*self.lives_by)
        node.do(1, "enable")
        self.watched(1).until_input("enabled")
        node.do(1, "disable")
        node.do(1, "release")
        node.leave()


class TwoHosts(Networks):
    """The interface is named, and all the rest is as it comes."""

    dds = {"interfaces": [OTHER], "ros2": True, "role": "engineer"}

    def test_nodes_of_another_host_read_and_command(self):
        for vendor in self.each_vendor():
            self.assert_it_reads_and_commands(self.node(vendor))


class StaticPeers(Networks):
    """Where a network has no multicast."""

    dds = {"interfaces": [OTHER], "peers": [HOST_ADDRESS], "role": "engineer"}

    def environment(self, vendor):
        if vendor == CYCLONE:
            return {"CYCLONEDDS_URI": CYCLONE_PEERS.format(own=HOST_ADDRESS, peer=OTHER_ADDRESS)}
        # Of a participant of the gateway's host the first ports are tried.
        locator = "<locator><udpv4><address>{}</address><port>{}</port></udpv4></locator>"
        locators = "".join(locator.format(OTHER_ADDRESS, 7410 + 250 * self.domain + 2 * index) for index in range(4))
        return {"FASTRTPS_DEFAULT_PROFILES_FILE": self.write_file("peers.xml", FAST_PEERS.format(locators=locators))}

    def test_nodes_named_by_address_read_and_command(self):
        for vendor in self.each_vendor():
            self.assert_it_reads_and_commands(self.node(vendor, **self.environment(vendor)))


class DiscoveryServer(Networks):
    """Of Fast DDS: Cyclone DDS has none, and does not speak with it."""

    address = HOST_ADDRESS
    dds = {"interfaces": [OTHER], "discovery_servers": [f"{HOST_ADDRESS}:{DISCOVERY_PORT}"], "role": "engineer"}

    def prepare(self):
        where = in_host() if self.address == HOST_ADDRESS else []
        self.keep(Program("discovery server", [*where, "fast-discovery-server", "-i", "0", "-l", self.address, "-p", str(DISCOVERY_PORT)]))

    def test_nodes_that_know_the_server_alone_read_and_command(self):
        self.assert_it_reads_and_commands(self.node(FAST, ROS_DISCOVERY_SERVER=f"{self.address}:{DISCOVERY_PORT}"))


class DiscoveryServerHere(DiscoveryServer):
    """On the gateway's own computer: Fast DDS turns its address into the loopback's, which must be named as well."""

    address = OTHER_ADDRESS
    dds = {"interfaces": ["lo", OTHER], "discovery_servers": [f"{OTHER_ADDRESS}:{DISCOVERY_PORT}"], "role": "engineer"}

    def test_nodes_that_know_the_server_alone_read_and_command(self):
        super().test_nodes_that_know_the_server_alone_read_and_command()


class Domains(Networks):
    """ROS_DOMAIN_ID is the gateway's "domain"; another one sees nothing."""

    dds = {"ros2": True}
    nodes_on_the_host = False

    def test_a_node_of_another_domain_sees_nothing(self):
        other = self.keep(Peer(FAST, self.domain + 1, (), "as_it_comes"))
        other.say("reader", "axis_state")
        node = self.node(FAST)
        node.read("axis_state")
        self.assertEqual(node.sample("axis_state", axis=1)["name"], "serial")
        self.assertEqual(other.all("matched", "axis_state"), [])


class Secured(Networks):
    """PKI-DH, permissions and AES-GCM, by a QoS file. Debian's Cyclone DDS comes without its security plugins."""

    dds = {"interfaces": [OTHER], "qos_file": "secure.xml", "ros2": True,
           "roles": [{"certificate": "operator.cert.pem", "role": "operator"}, {"certificate": "engineer.cert.pem", "role": "engineer"}]}
    lives_by = ("strength", 3, "manual", 20000)  # so that the reader of its lease takes part as well

    def prepare(self):
        command = of_page("docs/dds/networks.md", "deploy/examples/dds/security/make")
        program, *given = command.split()
        self.assertEqual(given, ["/etc/axisgate/dds", "0", "192.168.1.10"])
        subprocess.run([program, self.folder, str(self.domain), OTHER_ADDRESS], cwd=SOURCE, check=True, capture_output=True)

    def test_who_has_a_certificate_reads_and_commands_and_a_stranger_sees_nothing(self):
        stranger = self.node(FAST)
        stranger.say("reader", "axis_state")
        node = self.node(FAST, FASTRTPS_DEFAULT_PROFILES_FILE=self.path("operator.xml"))
        self.assert_it_reads_and_commands(node)
        self.assertEqual(stranger.all("sample", "axis_state"), [])

    def test_who_commands_has_the_role_of_its_certificate(self):
        results = {}
        for name in ("operator", "engineer"):
            node = self.node(FAST, FASTRTPS_DEFAULT_PROFILES_FILE=self.path(f"{name}.xml"))
            node.ask_objects()
            results[name] = node.object(1, 0x6081, size=4, write=1, value=1000)["result"]
            self.assertEqual(node.object(1, 0x6081, size=4)["result"], DONE)
            node.leave()
        self.assertEqual(results, {"operator": ROLE, "engineer": DONE})

    def test_who_may_read_alone_commands_nothing(self):
        viewer = self.node(FAST, FASTRTPS_DEFAULT_PROFILES_FILE=self.path("viewer.xml"))
        viewer.read("axis_state")
        self.assertEqual(viewer.sample("axis_state", axis=1)["name"], "serial")
        viewer.say("writer", "axis_command")
        until("its library refuses the writer", lambda: viewer.process.poll() is not None)


if __name__ == "__main__":
    main()
