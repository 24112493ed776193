// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of a stream as they travel over NATS.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>

#include "gst/common/refs.h"

namespace lidar::nats {

/// Immutable, so threads can share it.
class StreamFormat {
 public:
  using Ptr = std::shared_ptr<const StreamFormat>;

  /// Returns null, and `why` for a user, if streams of `caps` cannot be sent.
  static Ptr FromCaps(GstCaps* caps, std::string* why);
  /// Reads text of the network; returns null if FromCaps() cannot have sent it.
  static Ptr FromText(const std::string& text);

  GstCaps* caps() const { return caps_.get(); }
  const std::string& text() const { return text_; }
  /// CRC of the text, 16 hexadecimal digits.
  const std::string& id() const { return id_; }
  /// Estimated memory [bytes] of the text, and of the caps with the same content.
  std::size_t memory() const { return 2 * text_.size(); }
  /// Returns true if a buffer of these caps may have `size` bytes.
  bool Fits(std::size_t size) const;

 private:
  gst::CapsPtr caps_;
  std::string text_;
  std::string id_;
  std::size_t size_ = 0;         // size of a buffer [bytes]; 0: any
  std::size_t longer_size_ = 0;  // size of a pose with covariance [bytes]; 0: no pose
  std::size_t multiple_ = 1;     // divides the size of a buffer [bytes]
};

/// True for 16 hexadecimal digits.
bool IsFormatId(const std::string& text);

}  // namespace lidar::nats
