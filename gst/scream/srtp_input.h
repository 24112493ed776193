// SPDX-License-Identifier: LGPL-2.1-or-later
// The way in from a socket: every datagram is tried with the keys that are valid now.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "common/refs.h"
#include "scream/srtp_decoder.h"
#include "scream/srtp_key.h"

namespace lidar::gst {

struct SrtpCounts {
  std::uint64_t received = 0;  // datagrams
  std::uint64_t refused = 0;   // wrong key, replayed, damaged or not protected
  std::uint64_t key_changes = 0;
};

/// Takes the place of the link between `socket` and `target`: events and queries pass, datagrams
/// pass decoded or not at all. A new key is valid beside the old one; once a packet fits it the
/// old one is kept for stragglers and then forgotten. A stream that nobody knows is first tried
/// apart, only so often in a second, so that a flood of strangers costs neither time nor memory.
class SrtpInput {
 public:
  using OnNewKey = std::function<void(const SrtpKey&)>;

  /// `on_new_key` is called in the streaming thread once the other end uses a newer key.
  SrtpInput(GstElement* bin, const SrtpPolicy& policy, OnNewKey on_new_key);
  ~SrtpInput();
  SrtpInput(const SrtpInput&) = delete;
  SrtpInput& operator=(const SrtpInput&) = delete;

  /// Takes the two pads, that are not linked. False where they do not fit.
  bool Link(GstPad* socket, GstPad* target);
  /// From any thread. False where the srtp plugin is missing.
  bool AddKey(const SrtpKey& key);
  SrtpCounts counts() const;

 private:
  struct Stream {
    bool known = false;          // a packet of it passed
    std::uint32_t rollover = 0;  // the guess in use while not known
    unsigned failures = 0;       // since the last packet that passed
    gint64 passed_at = 0;        // monotonic time [us]
  };
  struct Key {
    std::unique_ptr<SrtpDecoder> decoder;  // of streams that are known
    std::unique_ptr<SrtpDecoder> trial;    // of others
  };
  /// What may be tried on strangers now.
  class Allowance {
   public:
    bool Take(gint64 now_us);

   private:
    gint64 filled_at_ = 0;
    double left_ = 0;
  };

  void InstallEntry();
  void InstallExit();
  GstFlowReturn OnDatagram(GstBuffer* datagram);
  bool DecodeKnown(GstBuffer* datagram, std::uint32_t ssrc, GstFlowReturn* flow);
  bool TryStranger(GstBuffer* datagram, std::uint32_t ssrc, GstFlowReturn* flow);
  void UpdateKeys();
  void OnPassed(std::uint32_t ssrc, std::size_t key);
  void OnRefused(Stream* stream);
  void Warn();
  Stream& StreamOf(std::uint32_t ssrc);
  void Reset();

  GstElement* bin_;
  SrtpPolicy policy_;
  OnNewKey on_new_key_;
  PadPtr entry_;
  PadPtr exit_;

  std::mutex mutex_;  // guards added_
  std::vector<Key> added_;

  // Of the streaming thread.
  std::vector<Key> keys_;   // oldest first
  std::size_t in_use_ = 0;  // of the packet that passed last
  std::size_t newest_used_ = 0;
  gint64 forget_old_at_ = 0;  // monotonic time [us]
  std::map<std::uint32_t, Stream> streams_;
  Allowance allowance_;
  unsigned tried_ = 0;  // strangers, since the trial decoders were cleared
  bool warned_ = false;

  std::atomic<std::uint64_t> received_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> key_changes_{0};
};

}  // namespace lidar::gst
