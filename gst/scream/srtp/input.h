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
#include <utility>
#include <vector>

#include "gst/common/refs.h"
#include "gst/scream/srtp/copies.h"
#include "gst/scream/srtp/decoder.h"
#include "gst/scream/srtp/key.h"

namespace lidar::gst {

struct SrtpCounts {
  std::uint64_t received = 0;  // datagrams
  std::uint64_t refused = 0;   // wrong key, replayed, damaged or not protected
  std::uint64_t copies = 0;    // by another link of the sender
  std::uint64_t key_changes = 0;
};

/// Takes the place of the link between `socket` and `target`: events and queries pass, datagrams
/// pass decoded or not at all. A new key is valid beside the old one; once a packet fits it the old
/// one is kept for stragglers and then forgotten. An unknown stream is first tried apart, at a
/// bounded rate, so that a flood of strangers costs neither time nor memory. The RTCP of an SSRC is
/// a stream of its own: it carries its index, and says nothing of the rollover counter of the
/// media.
class SrtpInput {
 public:
  using OnNewKey = std::function<void(const SrtpKey&)>;

  /// `on_new_key` is called in the streaming thread once the other end uses a newer key.
  SrtpInput(GstElement* bin, const SrtpPolicy& policy, OnNewKey on_new_key);
  ~SrtpInput();
  SrtpInput(const SrtpInput&) = delete;
  SrtpInput& operator=(const SrtpInput&) = delete;

  /// Links two pads that have no link. Returns false if they do not fit.
  bool Link(GstPad* socket, GstPad* target);
  /// Callable from any thread. Returns false without the srtp plugin. A fifth key replaces the
  /// oldest.
  bool AddKey(const SrtpKey& key);
  /// Keys that no packet has fitted yet, newer than the one in use.
  std::size_t waiting_keys() const { return waiting_; }
  SrtpCounts counts() const;

 private:
  using StreamId = std::pair<bool, std::uint32_t>;  // whether it is RTCP, and its SSRC
  /// The header fields of a datagram.
  struct Head {
    StreamId stream() const { return {rtcp, ssrc}; }
    bool rtcp = false;
    std::uint16_t sequence = 0;  // of RTP
    std::uint32_t ssrc = 0;
  };
  /// Numbers from 1 on, to be tried. Rounds grow in length and begin again with short ones, so
  /// small numbers come up again and again. Each round begins at a random number: an attacker who
  /// uses up some numbers cannot keep one of them from coming up.
  class Search {
   public:
    std::uint32_t Next();

   private:
    std::uint32_t round_ = 1;
    std::uint32_t left_ = 0;
    std::uint32_t at_ = 0;
  };
  struct Stream {
    bool known = false;     // a packet of it passed; then:
    std::uint64_t key = 0;  // serial number of the newest key that fitted
    std::uint32_t rollover = 0;
    std::uint16_t sequence = 0;
    unsigned failures = 0;  // since the last packet that passed
    gint64 passed_at = 0;   // monotonic time [us]
    Search search;
  };
  struct Key {
    std::uint64_t serial = 0;
    // Tries of known media and RTCP, and of others. Media that is found starts its decoder
    // again, which would forget what RTCP had passed.
    std::unique_ptr<SrtpDecoder> media;
    std::unique_ptr<SrtpDecoder> rtcp;
    std::unique_ptr<SrtpDecoder> trial;
    SrtpDecoder& DecoderOf(const Head& head) const { return head.rtcp ? *rtcp : *media; }
  };
  /// The budget for tries on strangers.
  class Allowance {
   public:
    bool Take(gint64 now_us);
    /// Takes another try for the same packet, if more than half of the allowance is left.
    bool TakeSpare();

   private:
    gint64 filled_at_ = 0;
    double left_ = 0;
  };

  void InstallEntry();
  void InstallExit();
  GstFlowReturn OnDatagram(GstBuffer* datagram);
  static Head HeadOf(GstBuffer* datagram);
  BufferPtr Decode(GstBuffer* datagram, const Head& head);
  BufferPtr DecodeKnown(GstBuffer* datagram, const Head& head);
  BufferPtr TryStranger(GstBuffer* datagram, const Head& head);
  BufferPtr TryRollover(GstBuffer* datagram, const Head& head, std::uint32_t ahead);
  bool Fits(const Key& key, GstBuffer* datagram, std::uint32_t ssrc, std::uint32_t rollover);
  void UpdateKeys();
  void OnPassed(const Head& head, std::size_t key, std::uint32_t rollover);
  static bool IsLost(const Stream& stream);
  void Warn();
  Stream& StreamOf(const StreamId& id);
  void Reset();

  GstElement* bin_;
  SrtpPolicy policy_;
  OnNewKey on_new_key_;
  PadPtr entry_;
  PadPtr exit_;

  std::mutex mutex_;  // guards added_ and serial_
  std::vector<Key> added_;
  std::uint64_t serial_ = 0;

  // Only the streaming thread uses what follows.
  std::vector<Key> keys_;   // oldest first
  std::size_t in_use_ = 0;  // of the packet that passed last
  std::size_t newest_used_ = 0;
  gint64 forget_old_at_ = 0;  // monotonic time [us]
  std::map<StreamId, Stream> streams_;
  SrtpCopies copies_;
  Allowance allowance_;
  unsigned tried_ = 0;  // strangers, since the trial decoders were cleared
  bool warned_ = false;

  std::atomic<std::size_t> waiting_{0};
  std::atomic<std::uint64_t> received_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> copied_{0};
  std::atomic<std::uint64_t> key_changes_{0};
};

}  // namespace lidar::gst
