// SPDX-License-Identifier: LGPL-2.1-or-later
// The input from a socket: tries the valid keys on each datagram.
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
  std::uint64_t copies = 0;    // came by another link of the sender
  std::uint64_t key_changes = 0;
};

/// Replaces the link between `socket` and `target`: events and queries pass, and datagrams pass
/// decoded or not at all. After a packet fits a new key, the old key stays valid for a while. An
/// unknown stream is first tried in another decoder, at a bounded rate, so that a flood of unknown
/// streams costs neither time nor memory. The RTCP of an SSRC is a stream of its own, because its
/// index says nothing about the media's rollover counter.
class SrtpInput {
 public:
  using OnNewKey = std::function<void(const SrtpKey&)>;
  using OnDtls = std::function<void(GstBuffer*)>;

  /// The streaming thread calls `on_new_key` once the other end uses a newer key.
  SrtpInput(GstElement* bin, const SrtpPolicy& policy, OnNewKey on_new_key);
  ~SrtpInput();
  SrtpInput(const SrtpInput&) = delete;
  SrtpInput& operator=(const SrtpInput&) = delete;

  /// Links two pads that have no link. Returns false if they do not fit.
  bool Link(GstPad* socket, GstPad* target);
  /// Gives DTLS datagrams to `on_dtls`; without it they are refused. Call it before Link().
  void SetDtls(OnDtls on_dtls) { on_dtls_ = std::move(on_dtls); }
  /// All threads may call it. Returns false without the srtp plugin. The key of the packets that
  /// pass stays. Of more than two newer keys, the oldest is dropped.
  bool AddKey(const SrtpKey& key);
  /// Keys newer than the present one that fitted no packet yet.
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
  /// Produces the rollover counters to try, from 1 on. Rounds become longer and restart with short
  /// ones, so that small numbers recur often. Each round begins at a random number: an attacker who
  /// uses up some numbers cannot block one of them.
  class Search {
   public:
    std::uint32_t Next();

   private:
    std::uint32_t round_ = 1;
    std::uint32_t left_ = 0;
    std::uint32_t at_ = 0;
  };
  struct Stream {
    bool known = false;     // a packet has passed; then the fields below are valid:
    std::uint64_t key = 0;  // serial number of the newest key that has fitted
    std::uint32_t rollover = 0;
    std::uint16_t sequence = 0;
    unsigned failures = 0;  // since the last packet that passed
    Time passed_at{};       // of that packet
    Search search;
  };
  struct Key {
    std::uint64_t serial = 0;
    // Decoders of media, of RTCP, and for trials. RTCP has its own, because a media stream that is
    // found restarts its decoder, which would forget the RTCP that has passed.
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
  std::size_t in_use_ = 0;  // key of the last packet that passed
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
