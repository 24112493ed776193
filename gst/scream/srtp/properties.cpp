// SPDX-License-Identifier: LGPL-2.1-or-later
// The properties and statistics of SRTP that screamsink and screamsrc share.
#include "gst/scream/srtp/layer.h"

namespace lidar::gst {
namespace {

enum : guint { kKey, kCipher, kAuth };

void InstallText(GObjectClass* object, guint id, const char* name, const char* blurb,
                 const char* initial, guint flags) {
  g_object_class_install_property(
      object, id,
      g_param_spec_string(name, name, blurb, initial,
                          static_cast<GParamFlags>(flags | G_PARAM_STATIC_STRINGS)));
}

}  // namespace

bool StartSrtp(const SrtpSettings& settings, const SrtpLinks& links,
               std::shared_ptr<SrtpLayer>* layer) {
  if (settings.key.empty()) return true;
  std::string error;
  *layer = SrtpLayer::Create(settings, links, &error);
  if (*layer) return true;
  GST_ELEMENT_ERROR(links.bin, RESOURCE, SETTINGS, ("SRTP cannot be used: %s.", error.c_str()),
                    (nullptr));
  return false;
}

bool ChangeSrtpKey(GstElement* bin, SrtpLayer* layer, const SrtpSettings& settings) {
  std::string error = "SRTP begins and ends with a start from NULL";
  if (layer != nullptr && !settings.key.empty() && layer->ChangeKey(settings.key, &error))
    return true;
  GST_ELEMENT_WARNING(bin, RESOURCE, SETTINGS, ("The SRTP key stays as it is: %s.", error.c_str()),
                      (nullptr));
  return false;
}

void InstallSrtpProperties(GObjectClass* object, guint first_id) {
  const SrtpSettings defaults;
  InstallText(
      object, first_id + kKey, "srtp-key",
      "SRTP master key and salt: hexadecimal digits, or file:PATH or env:NAME where they "
      "stand, so that no list of processes shows them; empty for no SRTP. Set while playing, "
      "it is a new key: at the receiver first",
      nullptr, G_PARAM_WRITABLE | GST_PARAM_MUTABLE_PLAYING);
  InstallText(object, first_id + kCipher, "srtp-cipher",
              "aes-128-icm (60 digits of key), aes-256-icm (92), aes-128-gcm (56) or "
              "aes-256-gcm (88)",
              defaults.cipher.c_str(), G_PARAM_READWRITE | GST_PARAM_MUTABLE_READY);
  InstallText(object, first_id + kAuth, "srtp-auth",
              "hmac-sha1-80 or hmac-sha1-32; of no meaning with gcm", defaults.auth.c_str(),
              G_PARAM_READWRITE | GST_PARAM_MUTABLE_READY);
}

bool SetSrtpField(SrtpSettings* settings, guint index, const GValue* value) {
  const gchar* text = g_value_get_string(value);
  std::string* fields[] = {&settings->key, &settings->cipher, &settings->auth};
  *fields[index] = text != nullptr ? text : "";
  return index == kKey;
}

void GetSrtpProperty(const SrtpSettings& settings, guint index, GValue* value) {
  g_value_set_string(value, index == kCipher ? settings.cipher.c_str() : settings.auth.c_str());
}

void AddSrtpStats(const SrtpLayer* layer, GstStructure* stats) {
  if (layer == nullptr || stats == nullptr) return;
  const SrtpCounts counts = layer->counts();
  gst_structure_set(stats, "srtp-received", G_TYPE_UINT64, counts.received, "srtp-refused",
                    G_TYPE_UINT64, counts.refused, "srtp-key-changes", G_TYPE_UINT64,
                    counts.key_changes, nullptr);
}

}  // namespace lidar::gst
