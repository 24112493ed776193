// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of a stream as they travel over NATS.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>

#include "gst/common/refs.h"

namespace lidar::nats {

/// Never changes once it is made, so threads share it.
class StreamFormat {
 public:
  using Ptr = std::shared_ptr<const StreamFormat>;

  /// Null where streams of `caps` do not travel; `why` then says so in words for a user.
  static Ptr FromCaps(GstCaps* caps, std::string* why);
  /// From text that came over the network; null where it is not what FromCaps() sends.
  static Ptr FromText(const std::string& text);

  GstCaps* caps() const { return caps_.get(); }
  const std::string& text() const { return text_; }
  /// 16 hexadecimal digits, which depend on the text alone.
  const std::string& id() const { return id_; }
  /// About what it takes [bytes]: the caps hold again what the text says.
  std::size_t memory() const { return 2 * text_.size(); }
  /// True where a buffer of these caps may have `size` bytes.
  bool Fits(std::size_t size) const;

 private:
  gst::CapsPtr caps_;
  std::string text_;
  std::string id_;
  std::size_t size_ = 0;         // of a buffer [bytes]; 0: any
  std::size_t longer_size_ = 0;  // of a buffer that says more [bytes]; 0: none does
  std::size_t multiple_ = 1;     // a buffer has a multiple of these [bytes]
};

/// True for what FromText() takes as an id.
bool IsFormatId(const std::string& text);

}  // namespace lidar::nats
