// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ouster_src with all kinds of addresses, and of several sources on one port. The tests of
// multicast run in a network namespace of their own, so they need root.
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "gst/net/udp_socket.h"
#include "src/tools/common/udp_socket.h"
#include "tests/elements/ouster/live_receiver.h"
#include "tests/elements/ouster/software_sensor.h"
#include "tests/support/element_stats.h"
#include "tests/support/ipv6.h"

namespace lidar::test {
namespace {

using gst::BufferPtr;

/// Enters a new network namespace whose loopback interface supports multicast. Returns false if the
/// user is not allowed to make a namespace.
bool EnterOwnNetwork() {
  if (unshare(CLONE_NEWNET) != 0) return false;
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  bool ok = fd >= 0 && ioctl(fd, SIOCGIFFLAGS, &request) == 0;
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP | IFF_MULTICAST);
  ok = ok && ioctl(fd, SIOCSIFFLAGS, &request) == 0;
  if (fd >= 0) close(fd);
  return ok;
}

/// Adds two Ethernet interfaces, because the loopback interface does not support multicast over
/// IPv6. If a socket names no interface, the kernel uses the first of the two for multicast.
/// Returns false if iproute2 is missing.
bool AddEthernets() {
  return std::system(
             "for i in 0 2; do ip link add lidar$i type veth peer name lidar$((i + 1)) && "
             "ip link set lidar$i up && ip link set lidar$((i + 1)) up && "
             "ip addr add fd00:6c69:$i::1/64 dev lidar$i nodad || exit 1; done 2>/dev/null") == 0;
}

// This must run before main(), because GLib's threads inherit the namespace of the thread that
// starts them.
const bool kOwnNetwork = EnterOwnNetwork();
const bool kEthernet = kOwnNetwork && AddEthernets();

/// Returns false in a root without /etc/hosts. GLib's resolver, which ouster_src uses, knows the
/// name without that file.
bool SoftwareSensorKnowsLocalhost() {
  try {
    tools::ResolveAddress("0", "localhost");
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

std::string SerialOf(const gst::MessagePtr& message) {
  const char* serial = gst_structure_get_string(gst_message_get_structure(message.get()), "serial");
  return serial != nullptr ? serial : "";
}

TEST(OusterNetwork, AHostNameGoesThroughTheResolver) {
  SoftwareSensor sensor({});
  Receiver receiver("localhost:" + sensor.port(), "udp-dest=127.0.0.1");
  EXPECT_TRUE(receiver.Pull());
}

TEST(OusterNetwork, TheSensorGetsTheHostNameOfTheDestination) {
  if (!SoftwareSensorKnowsLocalhost()) GTEST_SKIP() << "this machine does not know localhost";
  SoftwareSensor sensor({});
  Receiver receiver("localhost:" + sensor.port(), "udp-dest=localhost");
  EXPECT_TRUE(receiver.Pull());
  EXPECT_EQ(sensor.config()["udp_dest"], "localhost");
}

TEST(OusterNetwork, AHostNameThatNobodyHasIsAClearError) {
  Receiver receiver("os-1.invalid", "reconnect=false");
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("os-1.invalid"), std::string::npos) << error;
  EXPECT_NE(error.find("resolve"), std::string::npos) << error;
}

TEST(OusterNetwork, ASensorMayHaveAnIpv6Address) {
  if (!HasIpv6()) GTEST_SKIP() << "this machine has no IPv6";
  SoftwareSensor::Options options;
  options.http_address = "::1";
  SoftwareSensor sensor(options);
  Receiver receiver("[::1]:" + sensor.port(), "udp-dest=@auto");
  EXPECT_TRUE(receiver.Pull());
  EXPECT_EQ(sensor.config()["udp_dest"], "::1");
}

TEST(OusterNetwork, AnAddressToReceiveOnKeepsOthersOut) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=127.0.0.1 address=127.0.0.2");
  const gst::MessagePtr message = receiver.Await("ouster-connection-changed");
  ASSERT_TRUE(message);
  const char* reason = gst_structure_get_string(gst_message_get_structure(message.get()), "reason");
  EXPECT_NE(std::string(reason).find("sends to 127.0.0.1:" + std::to_string(receiver.port())),
            std::string::npos)
      << reason;
}

TEST(OusterMulticast, ReachesEveryReceiverOfTheGroup) {
  if (!kOwnNetwork) GTEST_SKIP() << "only root can make a network namespace for multicast";
  const std::string group = "239.201.7.1";
  SoftwareSensor::Options options;
  options.multicast_iface = "lo";
  SoftwareSensor sensor(options);
  const std::string properties =
      "multicast-iface=lo multicast-group=" + group + " udp-dest=" + group;
  const Receiver::Ports ports{FreePort(), FreePort()};
  Receiver first(sensor.host(), properties, ports);
  ASSERT_TRUE(first.Pull());
  // Another program opens a socket that does not share its port with others.
  GError* raw = nullptr;
  const gst::UdpBind bind{"", ports.lidar, G_SOCKET_FAMILY_IPV4, true};
  const std::unique_ptr<GSocket, gst::GObjectUnref> other(gst::OpenUdpSocket(bind, &raw));
  ASSERT_TRUE(other) << raw->message;
  ASSERT_TRUE(gst::JoinMulticast(other.get(), group, "lo", &raw)) << raw->message;
  g_socket_set_blocking(other.get(), TRUE);
  g_socket_set_timeout(other.get(), kPatience.count());
  std::vector<gchar> packet(65536);
  const gssize size = g_socket_receive(other.get(), packet.data(), packet.size(), nullptr, nullptr);
  EXPECT_EQ(size, static_cast<gssize>(32 + 16 * (12 + 32 * 12) + 32));
  EXPECT_TRUE(first.Pull());
}

TEST(OusterMulticast, WorksOverIpv6) {
  if (!kEthernet) GTEST_SKIP() << "needs root, iproute2 and a kernel with veth";
  const std::string group = "ff15::6c69:1";
  SoftwareSensor::Options options;
  options.multicast_iface = "lidar2";
  SoftwareSensor sensor(options);
  Receiver receiver(sensor.host(),
                    "multicast-iface=lidar2 multicast-group=" + group + " udp-dest=" + group);
  EXPECT_TRUE(receiver.Pull());
  EXPECT_EQ(sensor.config()["udp_dest"], group);
}

/// A fixture with two sensors that send to the same port of this machine.
class OusterOnePort : public ::testing::Test {
 protected:
  static SoftwareSensor::Options Second(const char* mode = "512x20") {
    SoftwareSensor::Options options;
    options.seed = 2;
    options.mode = mode;
    options.source = "127.0.0.2";
    return options;
  }
  const Receiver::Ports ports_{FreePort(), FreePort()};
};

/// Expects buffers without gaps. A gap is allowed if the kernel's buffer was full, if a sensor's
/// packets were reordered because its thread moved to another processor, or if the machine stopped
/// the sensor for a second.
void ExpectWholeScans(Receiver* receiver, int buffers) {
  int gaps = 0;
  for (int i = 0; i < buffers; ++i) {
    const BufferPtr buffer = receiver->Pull();
    ASSERT_TRUE(buffer) << i;
    gaps += i > 0 && GST_BUFFER_FLAG_IS_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT) ? 1 : 0;
  }
  const auto stat = [&](const char* name) { return StatOf(receiver->source(), name); };
  const guint64 lost = stat("packets-lost");  // read first, because packets continue to arrive
  EXPECT_LE(lost, stat("dropped-by-kernel"));
  const guint64 reasons = stat("dropped-by-kernel") + stat("packets-late") + stat("clock-jumps");
  EXPECT_TRUE(gaps == 0 || reasons > 0) << gaps;
}

TEST_F(OusterOnePort, EachSourceTakesItsOwnSensor) {
  SoftwareSensor a({});
  SoftwareSensor b(Second());
  ASSERT_NE(a.serial(), b.serial());
  Receiver of_a(a.host(), "udp-dest=@auto", ports_);
  Receiver of_b(b.host(), "udp-dest=@auto", ports_);
  EXPECT_EQ(SerialOf(of_a.Await("ouster-metadata-changed")), a.serial());
  EXPECT_EQ(SerialOf(of_b.Await("ouster-metadata-changed")), b.serial());
  ExpectWholeScans(&of_a, 40);
  ExpectWholeScans(&of_b, 40);
  for (Receiver* receiver : {&of_a, &of_b})
    EXPECT_TRUE(Eventually([&] { return StatOf(receiver->source(), "packets-foreign") > 20; }));
  EXPECT_EQ(StatOf(of_a.source(), "restarts"), 0U);
}

TEST_F(OusterOnePort, SensorsMayDifferInModeAndOneMayLeave) {
  SoftwareSensor a({});
  SoftwareSensor b(Second("1024x10"));
  Receiver of_a(a.host(), "udp-dest=@auto", ports_);
  {
    Receiver of_b(b.host(), "udp-dest=@auto", ports_);
    ExpectWholeScans(&of_b, 20);
    EXPECT_EQ(of_b.Info().sensor_model->columns_per_scan, 1024U);
  }
  ExpectWholeScans(&of_a, 40);
  EXPECT_EQ(of_a.Info().sensor_model->columns_per_scan, 512U);
  EXPECT_EQ(StatOf(of_a.source(), "packets-wrong-size"), 0U);
}

TEST_F(OusterOnePort, TwoSourcesMayHaveTheSameSensor) {
  SoftwareSensor sensor({});
  Receiver first(sensor.host(), "udp-dest=@auto", ports_);
  ASSERT_TRUE(first.Pull());
  Receiver second(sensor.host(), "udp-dest=@auto", ports_);
  ExpectWholeScans(&second, 40);
  ExpectWholeScans(&first, 40);
  EXPECT_EQ(StatOf(first.source(), "packets-foreign"), 0U);
}

TEST_F(OusterOnePort, TheRestartOfOneDoesNotDisturbTheOther) {
  SoftwareSensor a({});
  SoftwareSensor b(Second());
  Receiver of_a(a.host(), "udp-dest=@auto", ports_);
  Receiver of_b(b.host(), "udp-dest=@auto", ports_);
  ASSERT_TRUE(of_a.Pull());
  ASSERT_TRUE(of_b.Pull());
  const auto init_id = [&] {
    return nlohmann::json::parse(b.state().MetadataJson())["sensor_info"]["initialization_id"];
  };
  const auto before = init_id();
  b.state().Restart();
  ASSERT_TRUE(of_b.PullUntil(
      [&](GstBuffer*) { return init_id() != before && StatOf(of_b.source(), "packets") > 50; }));
  ExpectWholeScans(&of_a, 40);
}

}  // namespace
}  // namespace lidar::test
