// SPDX-License-Identifier: LGPL-2.1-or-later
// How a bin starts SRTP, changes its key and shows its counters.
#include "gst/common/stats.h"
#include "gst/scream/srtp/layer.h"

namespace lidar::gst {

const std::array<Property<SrtpSettings>, 5>& SrtpRows() {
  static const std::array<Property<SrtpSettings>, 5> rows = {{
      {"srtp-key",
       "SRTP master key and salt: hexadecimal digits, or file:PATH or env:NAME to read them from, "
       "so that no list of processes shows them; empty: no SRTP. To change the key while playing, "
       "set it at the receiver first",
       &SrtpSettings::key, 0, 0, G_PARAM_WRITABLE | GST_PARAM_MUTABLE_PLAYING},
      {"srtp-cipher",
       "aes-128-icm (60 digits of key), aes-256-icm (92), aes-128-gcm (56) or aes-256-gcm (88)",
       &SrtpSettings::cipher},
      {"srtp-auth", "hmac-sha1-80 or hmac-sha1-32; has no effect with gcm", &SrtpSettings::auth},
      {"dtls-certificate",
       "PEM file with our certificate and its private key: DTLS then negotiates the SRTP keys, "
       "instead of srtp-key",
       &SrtpSettings::dtls_certificate},
      {"dtls-peer-certificate", "PEM file with the certificate of the only peer to trust",
       &SrtpSettings::dtls_peer_certificate},
  }};
  return rows;
}

bool StartSrtp(const SrtpSettings& settings, const SrtpPlaces& places,
               std::shared_ptr<SrtpLayer>* layer) {
  if (settings.key.empty() && !settings.by_dtls()) return true;
  std::string error;
  *layer = SrtpLayer::Create(settings, places, &error);
  if (*layer) return true;
  GST_ELEMENT_ERROR(places.bin, RESOURCE, SETTINGS, ("SRTP cannot be used: %s.", error.c_str()),
                    (nullptr));
  return false;
}

bool TakeSrtpKey(GstElement* bin, SrtpLayer* layer, const std::string& key) {
  std::string error = "SRTP can be turned on or off only in the state NULL";
  if (layer != nullptr && !key.empty() && layer->ChangeKey(key, &error)) return true;
  GST_ELEMENT_WARNING(bin, RESOURCE, SETTINGS, ("The SRTP key stays as it is: %s.", error.c_str()),
                      (nullptr));
  return false;
}

void AddSrtpStats(const SrtpLayer* layer, GstStructure* stats) {
  static const std::array<Stat<SrtpCounts>, 4> kStats = {{
      {"srtp-received", &SrtpCounts::received},
      {"srtp-refused", &SrtpCounts::refused},
      {"srtp-copies", &SrtpCounts::copies},
      {"srtp-key-changes", &SrtpCounts::key_changes},
  }};
  static const std::array<Stat<DtlsCounts>, 4> kDtlsStats = {{
      {"dtls-handshakes", &DtlsCounts::handshakes},
      {"dtls-refused", &DtlsCounts::refused},
      {"dtls-dropped", &DtlsCounts::dropped},
      {"packets-unkeyed", &DtlsCounts::unkeyed},
  }};
  if (layer != nullptr) AddStats(stats, kStats, layer->counts());
  if (layer != nullptr && layer->by_dtls()) AddStats(stats, kDtlsStats, layer->dtls_counts());
}

}  // namespace lidar::gst
