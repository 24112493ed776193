// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of a stream, and the text in which they are sent over NATS.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>

#include "gst/common/refs.h"

namespace lidar::nats {

/// The caps of a stream and their text. Immutable, so threads can share an object.
class StreamFormat {
 public:
  using Ptr = std::shared_ptr<const StreamFormat>;

  /// Makes a format from `caps`. Returns null and sets `why`, a text for users, if a stream with
  /// `caps` cannot be sent.
  static Ptr FromCaps(GstCaps* caps, std::string* why);
  /// Makes a format from text that was received. Returns null if the text is not of caps that
  /// FromCaps() accepts.
  static Ptr FromText(const std::string& text);

  GstCaps* caps() const { return caps_.get(); }
  const std::string& text() const { return text_; }
  /// Returns the CRC of the text as 16 hexadecimal digits.
  const std::string& id() const { return id_; }
  /// Returns the estimated memory of the text and the caps together [bytes].
  std::size_t memory() const { return 2 * text_.size(); }
  /// Returns true if a buffer with these caps may have `size` bytes.
  bool Fits(std::size_t size) const;

 private:
  gst::CapsPtr caps_;
  std::string text_;
  std::string id_;
  std::size_t size_ = 0;         // size of a buffer [bytes]; 0: any
  std::size_t longer_size_ = 0;  // size of a pose with covariance [bytes]; 0: no pose
  std::size_t multiple_ = 1;     // the size of a buffer is a multiple of this [bytes]
};

/// Returns true if `text` consists of 16 hexadecimal digits.
bool IsFormatId(const std::string& text);

}  // namespace lidar::nats
