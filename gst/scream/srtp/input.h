// SPDX-License-Identifier: LGPL-2.1-or-later
// The input from a socket: decodes each datagram with one of the valid keys.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "gst/common/refs.h"
#include "gst/scream/srtp/copies.h"
#include "gst/scream/srtp/decoder.h"
#include "gst/scream/srtp/key.h"
#include "src/base/allowance.h"
#include "src/base/time.h"

namespace lidar::gst {

struct SrtpCounts {
  std::uint64_t received = 0;  // datagrams that passed or were refused
  std::uint64_t refused = 0;   // wrong key, replayed, damaged or not protected
  std::uint64_t copies = 0;    // arrived over another link of the sender
  std::uint64_t key_changes = 0;
};

/// Is inserted between the pads `socket` and `target`. Events and queries pass. A datagram that can
/// be decoded passes; any other datagram is dropped. After the first packet that was protected with
/// a new key, the old key stays valid for a while. Packets of unknown streams are tried in a
/// separate decoder at a limited rate, so that a flood of unknown streams costs little time and
/// memory. The RTCP of an SSRC is a separate stream, because the index in RTCP says nothing about
/// the rollover counter of the media.
class SrtpInput {
 public:
  using OnNewKey = std::function<void(const SrtpKey&)>;
  using OnDtls = std::function<void(GstBuffer*)>;

  /// The streaming thread calls `on_new_key` when the other end begins to use a newer key.
  SrtpInput(GstElement* bin, const SrtpPolicy& policy, OnNewKey on_new_key);
  ~SrtpInput();
  SrtpInput(const SrtpInput&) = delete;
  SrtpInput& operator=(const SrtpInput&) = delete;

  /// Links `socket` and `target` through this input. The pads must not be linked yet. Returns false
  /// if they cannot be linked.
  bool Link(GstPad* socket, GstPad* target);
  /// Gives DTLS datagrams to `on_dtls`. Without this function, DTLS datagrams are refused. Call
  /// SetDtls() before Link().
  void SetDtls(OnDtls on_dtls) { on_dtls_ = std::move(on_dtls); }
  /// Adds a key. Any thread may call it. Returns false if the srtp plugin is missing. The key in
  /// use is kept. If more than two keys are newer, the oldest of the newer keys is dropped.
  bool AddKey(const SrtpKey& key);
  /// Returns the number of keys that are newer than the key in use and have not decoded a packet
  /// yet.
  std::size_t waiting_keys() const { return waiting_; }
  SrtpCounts counts() const;

 private:
  using StreamId = std::pair<bool, std::uint32_t>;  // true for RTCP, and the SSRC
  /// The header fields of a datagram.
  struct Head {
    StreamId stream() const { return {rtcp, ssrc}; }
    bool rtcp = false;
    std::uint16_t sequence = 0;  // RTP only
    std::uint32_t ssrc = 0;
  };
  /// Produces the rollover counters to try, which are at least 1. The counters are tried in rounds
  /// of growing length. After the longest round, the short rounds begin again, so that small
  /// numbers recur often. Each round begins at a random number. An attacker whose packets use up
  /// some numbers can therefore not choose which.
  class Search {
   public:
    std::uint32_t Next();

   private:
    std::uint32_t round_ = 1;
    std::uint32_t left_ = 0;
    std::uint32_t at_ = 0;
  };
  struct Stream {
    bool known = false;     // a packet has passed, and the fields below are valid
    std::uint64_t key = 0;  // serial number of the newest key that has decoded a packet
    std::uint32_t rollover = 0;
    std::uint16_t sequence = 0;
    unsigned failures = 0;  // since the last packet that passed
    Time passed_at{};       // time of the last packet that passed
    Search search;
  };
  struct Key {
    std::uint64_t serial = 0;
    // The decoders of media, of RTCP, and for trials. RTCP has a separate decoder: when a media
    // stream is found, its SSRC is restarted in the decoder of media, which removes all state of
    // the SSRC.
    std::unique_ptr<SrtpDecoder> media;
    std::unique_ptr<SrtpDecoder> rtcp;
    std::unique_ptr<SrtpDecoder> trial;
    SrtpDecoder& DecoderOf(const Head& head) const { return head.rtcp ? *rtcp : *media; }
  };
  PadPtr NewPad(const char* name, GstPadDirection direction);
  GstPad* Other(GstPad* pad) const { return pad == entry_.get() ? exit_.get() : entry_.get(); }
  GstFlowReturn OnDatagram(GstBuffer* datagram);
  static Head HeadOf(GstBuffer* datagram);
  BufferPtr Decode(GstBuffer* datagram, const Head& head);
  BufferPtr DecodeKnown(GstBuffer* datagram, const Head& head);
  BufferPtr TryStranger(GstBuffer* datagram, const Head& head);
  BufferPtr TryRollover(GstBuffer* datagram, const Head& head, std::uint32_t ahead);
  bool Fits(const Key& key, GstBuffer* datagram, std::uint32_t ssrc, std::uint32_t rollover);
  void UpdateKeys();
  void DropKey(std::size_t index);
  void OnPassed(const Head& head, std::size_t key, std::uint32_t rollover);
  static bool IsLost(const Stream& stream);
  void Warn();
  Stream& StreamOf(const StreamId& id);
  void Reset();

  GstElement* bin_;
  SrtpPolicy policy_;
  OnNewKey on_new_key_;
  OnDtls on_dtls_;
  PadPtr entry_ = NewPad("entry", GST_PAD_SINK);
  PadPtr exit_ = NewPad("exit", GST_PAD_SRC);

  std::mutex mutex_;  // guards added_ and serial_
  std::vector<Key> added_;
  std::uint64_t serial_ = 0;

  // Used by the streaming thread only:
  std::vector<Key> keys_;   // oldest first
  std::size_t in_use_ = 0;  // index of the key of the last packet that passed
  std::size_t newest_used_ = 0;
  std::optional<Time> forget_old_at_;
  std::map<StreamId, Stream> streams_;
  SrtpCopies copies_;
  Allowance trials_;    // of unknown and lost streams
  unsigned tried_ = 0;  // trials since the trial decoders were cleared
  bool warned_ = false;

  std::atomic<std::size_t> waiting_{0};
  std::atomic<std::uint64_t> passed_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> copied_{0};
  std::atomic<std::uint64_t> key_changes_{0};
};

}  // namespace lidar::gst
