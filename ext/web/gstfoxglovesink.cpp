// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-foxglovesink
 *
 * Shows clouds, poses and statistics in a browser, in Foxglove and in other programs that speak its
 * WebSocket protocol.
 *
 * |[
 * gst-launch-1.0 lidartestsrc is-live=true ! foxglovesink
 * ]|
 */
#include <gst/gst.h>

#include "ext/web/foxglove_input.h"
#include "ext/web/statistics.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/sink_pads.h"
#include "gst/common/stats.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_foxglove_sink_debug);
#define GST_CAT_DEFAULT gst_lidar_foxglove_sink_debug

namespace {

using namespace lidar::gst;
using lidar::web::Hub;
using lidar::web::InputSettings;
using lidar::web::SetSettings;
using lidar::web::SettingsOf;

struct Settings {
  guint port = 8765;
  std::string bind_address = "127.0.0.1";
  std::string token;
  std::string token_secret;
  std::string allowed_origins;
  std::string tls_certificate;
  std::string tls_private_key;
  guint max_clients = 8;
  guint max_points = 0;
  guint max_bitrate = 0;
  bool sync = true;
};

struct State {
  std::mutex mutex;  // guards the settings and `hub`
  Settings settings;
  std::shared_ptr<Hub> hub;  // exists in all states above NULL
  std::atomic<guint> next_pad{0};
};

struct Counters {
  guint port = 0;
  guint64 clients = 0;
  guint64 accepted = 0;
  guint64 refused = 0;
  guint64 evicted = 0;
  guint64 sent = 0;
  guint64 dropped = 0;
  guint64 bytes = 0;
  guint64 skipped = 0;
  guint64 clouds = 0;
  guint64 points = 0;
  guint64 scan_duration = 0;
  guint64 malformed = 0;
};

const std::array<Stat<Counters>, 13> kStats = {{
    {"port", &Counters::port},
    {"clients", &Counters::clients},
    {"clients-accepted", &Counters::accepted},
    {"clients-refused", &Counters::refused},
    {"connections-evicted", &Counters::evicted},
    {"messages-sent", &Counters::sent},
    {"messages-dropped", &Counters::dropped},
    {"bytes-sent", &Counters::bytes},
    {"scans-skipped", &Counters::skipped},
    {"clouds", &Counters::clouds},
    {"points-sent", &Counters::points},
    {"scan-duration", &Counters::scan_duration},
    {"malformed", &Counters::malformed},
}};

Counters CountersOf(const Hub& hub) {
  const auto& server = hub.server->counters();
  Counters c;
  c.port = hub.server->port();
  c.clients = server.clients;
  c.accepted = server.clients_accepted;
  c.refused = server.clients_refused;
  c.evicted = server.connections_evicted;
  c.sent = server.messages_sent;
  c.dropped = server.messages_dropped;
  c.bytes = server.bytes_sent;
  c.skipped = server.scans_skipped;
  c.clouds = hub.clouds;
  c.points = hub.points;
  c.scan_duration = hub.scan_duration;
  c.malformed = server.malformed + hub.malformed;
  return c;
}

const std::array<Property<InputSettings>, 3> kPadProperties = {{
    {"topic",
     "Topic of the channel; NULL: /points, /points_draco, /pose or /camera, with the number of the "
     "pad from "
     "the second on",
     &InputSettings::topic},
    {"frame-id", "Frame of the clouds or pictures, or of the sensor whose poses come",
     &InputSettings::frame_id},
    {"recording",
     "Files that an mcapsink writes of these slices, as its location has them; viewers may go back "
     "into them; NULL: there are none",
     &InputSettings::recording},
}};

}  // namespace

/// A sink pad of foxglovesink. It is a ghost pad of the input's pad, and has the properties of the
/// input.
G_DECLARE_FINAL_TYPE(GstLidarFoxglovePad, gst_lidar_foxglove_pad, GST, LIDAR_FOXGLOVE_PAD,
                     GstGhostPad)
struct _GstLidarFoxglovePad {
  GstGhostPad parent;
};

G_DEFINE_TYPE(GstLidarFoxglovePad, gst_lidar_foxglove_pad, GST_TYPE_GHOST_PAD)

/// Returns the input behind the pad, or NULL if there is none. The caller owns the reference.
static GstElement* InputOf(GstPad* pad) {
  const PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(pad)));
  return target ? gst_pad_get_parent_element(target.get()) : nullptr;
}

static void SetPadProperty(GObject* object, guint id, const GValue* value, GParamSpec*) {
  const ElementPtr input(InputOf(GST_PAD(object)));
  if (!input) return;
  InputSettings settings = SettingsOf(GST_LIDAR_FOXGLOVE_INPUT(input.get()));
  SetProperty(settings, kPadProperties[id - 1], value);
  SetSettings(GST_LIDAR_FOXGLOVE_INPUT(input.get()), settings);
}

static void GetPadProperty(GObject* object, guint id, GValue* value, GParamSpec*) {
  const ElementPtr input(InputOf(GST_PAD(object)));
  const InputSettings settings =
      input ? SettingsOf(GST_LIDAR_FOXGLOVE_INPUT(input.get())) : InputSettings{};
  GetProperty(settings, kPadProperties[id - 1], value);
}

static void gst_lidar_foxglove_pad_init(GstLidarFoxglovePad*) {}

static void gst_lidar_foxglove_pad_class_init(GstLidarFoxglovePadClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = SetPadProperty;
  object->get_property = GetPadProperty;
  InstallProperties(object, kPadProperties);
}

G_DECLARE_FINAL_TYPE(GstLidarFoxgloveSink, gst_lidar_foxglove_sink, GST, LIDAR_FOXGLOVE_SINK,
                     GstBin)
struct _GstLidarFoxgloveSink {
  GstBin parent;
  State* state;
};

G_DEFINE_TYPE_WITH_CODE(GstLidarFoxgloveSink, gst_lidar_foxglove_sink, GST_TYPE_BIN,
                        G_IMPLEMENT_INTERFACE(GST_TYPE_CHILD_PROXY, ServeSinkPads))
GST_ELEMENT_REGISTER_DEFINE(foxglovesink, "foxglovesink", GST_RANK_NONE,
                            gst_lidar_foxglove_sink_get_type())

static std::shared_ptr<Hub> HubOf(GObject* object) {
  State& state = *GST_LIDAR_FOXGLOVE_SINK(object)->state;
  const std::lock_guard lock(state.mutex);
  return state.hub;
}

static StructurePtr ReadStats(GObject* object) {
  State& state = *GST_LIDAR_FOXGLOVE_SINK(object)->state;
  Counters counters;
  {
    // Reads the counters under the lock instead of copying the pointer. The server's thread also
    // calls this function, and must not own the last reference to the hub.
    const std::lock_guard lock(state.mutex);
    if (state.hub) counters = CountersOf(*state.hub);
  }
  return ToStructure("application/x-foxglove-stats", kStats, counters);
}

static const std::array<Property<Settings>, 12> kProperties = {{
    {"port", "TCP port; 0: a free one, which stats name", &Settings::port, 0, 65535},
    {"bind-address", "Address to listen on; an address that other machines reach needs a token",
     &Settings::bind_address},
    {"token", "Token that clients must send: http://host:port/?token=...; NULL: none",
     &Settings::token},
    {"token-secret",
     "Secret, of 32 bytes at least, of tokens that are JSON Web Tokens signed by HS256; they need "
     "exp, and may have topics",
     &Settings::token_secret},
    {"allowed-origins",
     "Sites whose pages need no token, in addition to the sink's own page: "
     "https://app.foxglove.dev,...",
     &Settings::allowed_origins},
    {"tls-certificate", "PEM file of a certificate and its chain, for HTTPS; NULL: HTTP",
     &Settings::tls_certificate},
    {"tls-private-key", "PEM file of the certificate's key", &Settings::tls_private_key},
    {"max-clients", "Most clients at a time", &Settings::max_clients, 1, 1000},
    {"max-points",
     "Most points of a message: of a larger cloud every n-th point is sent; 0: all points",
     &Settings::max_points},
    {"max-bitrate",
     "Most bitrate of a viewer's coded slices; a viewer above it gets fewer scans; 0: no limit "
     "[bit/s]",
     &Settings::max_bitrate},
    {"sync", "Send buffers at their time by the pipeline's clock; false: as they arrive",
     &Settings::sync},
    {"stats",
     "port, clients, clients-accepted, clients-refused, connections-evicted, messages-sent, "
     "messages-dropped, bytes-sent [bytes], scans-skipped, clouds, points-sent, scan-duration "
     "[ns], malformed",
     ReadStats},
}};

/// Checks `bind-address`. If it is not an address, or if other machines can reach it without a
/// token, posts an error message and returns false.
static bool CheckAddress(GstElement* element, const Settings& s) {
  const lidar::web::ObjectPtr<GInetAddress> address(
      g_inet_address_new_from_string(s.bind_address.c_str()));
  if (!address) {
    GST_ELEMENT_ERROR(element, RESOURCE, SETTINGS,
                      ("bind-address \"%s\" is not an IP address.", s.bind_address.c_str()),
                      ("set it to an IPv4 or IPv6 address of this machine"));
    return false;
  }
  const bool has_token = !s.token.empty() || !s.token_secret.empty();
  if (g_inet_address_get_is_loopback(address.get()) || has_token) return true;
  GST_ELEMENT_ERROR(
      element, RESOURCE, SETTINGS,
      ("The address %s can be reached from other machines: set a token.", s.bind_address.c_str()),
      (nullptr));
  return false;
}

/// Checks the token secret and the TLS files. If a setting is wrong, posts an error message and
/// returns false.
static bool CheckSecrets(GstElement* element, const Settings& s) {
  constexpr std::size_t kShortest = 32;  // RFC 7518, section 3.2
  const char* wrong = nullptr;
  if (!s.token_secret.empty() && s.token_secret.size() < kShortest)
    wrong = "token-secret must have at least 32 bytes.";
  if (s.tls_certificate.empty() != s.tls_private_key.empty())
    wrong = "tls-certificate and tls-private-key must be set together.";
  if (wrong == nullptr) return true;
  GST_ELEMENT_ERROR(element, RESOURCE, SETTINGS, ("%s", wrong), (nullptr));
  return false;
}

static lidar::web::ServerConfig ConfigOf(GstElement* element, const Settings& s) {
  lidar::web::ServerConfig config;
  config.address = s.bind_address;
  config.port = static_cast<std::uint16_t>(s.port);
  config.token = s.token;
  config.token_secret = s.token_secret;
  config.allowed_origins = s.allowed_origins;
  config.certificate = s.tls_certificate;
  config.private_key = s.tls_private_key;
  config.max_clients = s.max_clients;
  config.max_bitrate = lidar::DataRate::BitsPerSecond(s.max_bitrate);
  config.name = "gst-lidar";
  // The server is deleted before the element, so `element` is valid in both functions.
  config.statistics = [element] { return lidar::web::StatisticsOf(element); };
  config.warn = [element](const std::string& text) {
    GST_ELEMENT_WARNING(element, RESOURCE, SETTINGS, ("%s", text.c_str()), (nullptr));
  };
  return config;
}

static bool Open(GstElement* element) {
  State& state = *GST_LIDAR_FOXGLOVE_SINK(element)->state;
  const Settings s = Snapshot(state);
  if (!CheckAddress(element, s) || !CheckSecrets(element, s)) return false;
  auto hub = std::make_shared<Hub>();
  hub->max_points = s.max_points;
  std::string error;
  hub->server = lidar::web::Server::Start(ConfigOf(element, s), &error);
  if (!hub->server) {
    GST_ELEMENT_ERROR(element, RESOURCE, OPEN_READ_WRITE,
                      ("Cannot serve on port %u of %s.", s.port, s.bind_address.c_str()),
                      ("%s", error.c_str()));
    return false;
  }
  GST_INFO_OBJECT(element, "serves on http%s://%s:%u/", s.tls_certificate.empty() ? "" : "s",
                  s.bind_address.c_str(), hub->server->port());
  const std::lock_guard lock(state.mutex);
  state.hub = std::move(hub);
  return true;
}

/// Calls `function` with each input and `data`. Inputs may be added or removed meanwhile, so
/// `function` may be called more than once with an input.
static void ForEachInput(GstElement* element, GstIteratorForeachFunction function, gpointer data) {
  GstIterator* inputs = gst_bin_iterate_elements(GST_BIN(element));
  while (gst_iterator_foreach(inputs, function, data) == GST_ITERATOR_RESYNC)
    gst_iterator_resync(inputs);
  gst_iterator_free(inputs);
}

/// Sets the hub of each input to the hub of the element, which may be null.
static void GiveHub(GstElement* element) {
  auto hub = HubOf(G_OBJECT(element));
  ForEachInput(
      element,
      [](const GValue* value, gpointer data) {
        lidar::web::SetHub(GST_LIDAR_FOXGLOVE_INPUT(g_value_get_object(value)),
                           *static_cast<std::shared_ptr<Hub>*>(data));
      },
      &hub);
}

static void Close(GstElement* element) {
  State& state = *GST_LIDAR_FOXGLOVE_SINK(element)->state;
  std::unique_lock lock(state.mutex);
  const auto hub = std::move(state.hub);
  state.hub.reset();
  lock.unlock();
  GiveHub(element);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  if (change == GST_STATE_CHANGE_NULL_TO_READY) {
    if (!Open(element)) return GST_STATE_CHANGE_FAILURE;
    GiveHub(element);
  }
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_foxglove_sink_parent_class)->change_state(element, change);
  const bool failed =
      change == GST_STATE_CHANGE_NULL_TO_READY && result == GST_STATE_CHANGE_FAILURE;
  if (failed || change == GST_STATE_CHANGE_READY_TO_NULL) Close(element);
  return result;
}

static GstPad* RequestPad(GstElement* element, GstPadTemplate* templ, const gchar* name,
                          const GstCaps*) {
  auto* self = GST_LIDAR_FOXGLOVE_SINK(element);
  guint number = 0;
  if (name == nullptr || sscanf(name, "sink_%u", &number) != 1)
    number = self->state->next_pad++;
  else
    self->state->next_pad = MAX(self->state->next_pad.load(), number + 1);
  const StringPtr pad_name(g_strdup_printf("sink_%u", number));
  auto* input = GST_ELEMENT(g_object_new(GST_TYPE_LIDAR_FOXGLOVE_INPUT, nullptr));
  lidar::web::InputSettings settings;
  settings.number = number;
  SetSettings(GST_LIDAR_FOXGLOVE_INPUT(input), settings);
  lidar::web::SetHub(GST_LIDAR_FOXGLOVE_INPUT(input), HubOf(G_OBJECT(element)));
  {
    const std::lock_guard lock(self->state->mutex);
    // The pipeline can play while some pads have no data yet, because "async" is FALSE. The
    // deadline is 0, because a viewer shows late data at once, and waiting for a deadline would
    // block a source without buffers.
    g_object_set(input, "sync", self->state->settings.sync, "async", FALSE, "processing-deadline",
                 guint64{0}, nullptr);
  }
  const PadPtr target(gst_element_get_static_pad(input, "sink"));
  gst_bin_add(GST_BIN(element), input);
  gst_element_sync_state_with_parent(input);
  return AddGhostSink(element, gst_lidar_foxglove_pad_get_type(), templ, pad_name.get(),
                      target.get());
}

static void ReleasePad(GstElement* element, GstPad* pad) {
  const ElementPtr input(InputOf(pad));
  const StringPtr name(gst_pad_get_name(pad));
  if (input) {
    // Stops the input first. This wakes a thread that waits in the input and holds the lock of the
    // pad.
    gst_element_set_locked_state(input.get(), TRUE);
    gst_element_set_state(input.get(), GST_STATE_NULL);
  }
  gst_pad_set_active(pad, FALSE);
  gst_ghost_pad_set_target(GST_GHOST_PAD(pad), nullptr);
  if (input) gst_bin_remove(GST_BIN(element), input.get());
  gst_child_proxy_child_removed(GST_CHILD_PROXY(element), G_OBJECT(pad), name.get());
  gst_element_remove_pad(element, pad);
}

/// Copies the property `sync` to all inputs.
static void PropertyChanged(GObject* object, GParamSpec* spec) {
  if (g_strcmp0(spec->name, "sync") != 0) return;
  gboolean sync = FALSE;
  g_object_get(object, "sync", &sync, nullptr);
  ForEachInput(
      GST_ELEMENT(object),
      [](const GValue* value, gpointer on) {
        g_object_set(g_value_get_object(value), "sync", *static_cast<gboolean*>(on), nullptr);
      },
      &sync);
}

static void gst_lidar_foxglove_sink_init(GstLidarFoxgloveSink* self) { self->state = new State; }

static void gst_lidar_foxglove_sink_class_init(GstLidarFoxgloveSinkClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_foxglove_sink_debug, "foxglovesink", 0, "Foxglove server");
  ServeState<GstLidarFoxgloveSink, gst_lidar_foxglove_sink_parent_class, kProperties,
             PropertyChanged>(klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  element->request_new_pad = RequestPad;
  element->release_pad = ReleasePad;
  Describe(klass,
           {"Foxglove server", "Sink/Network/PointCloud",
            "Serves clouds, poses and statistics to browsers and to Foxglove"},
           {{"sink_%u", GST_PAD_SINK,
             "application/x-pointcloud2; application/x-draco, geometry=xyz; "
             "application/x-odometry; application/x-lidar-slice; "
             "video/x-h264, stream-format=byte-stream, alignment=au; video/x-vp8",
             GST_PAD_REQUEST, gst_lidar_foxglove_pad_get_type()}});
  gst_type_mark_as_plugin_api(gst_lidar_foxglove_pad_get_type(), static_cast<GstPluginAPIFlags>(0));
}
