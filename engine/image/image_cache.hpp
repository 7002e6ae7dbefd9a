// Decoded images that several files share, known by their encoded bytes: the models of one pack
// often have one texture, in copies beside each other. Any thread; decodes each image in one
// thread.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>

#include "engine/image/image_io.hpp"

namespace psygen::image {

// A decoded image that several owners share.
using ImagePtr = std::shared_ptr<const Image>;

class ImageCache {
 public:
  // Keeps the images decoded last, up to `kept_bytes` of pixels, and finds others that are in use.
  explicit ImageCache(std::uint64_t kept_bytes = std::uint64_t{128} << 20)
      : kept_bytes_(kept_bytes) {}

  // The image of these bytes. Fails like decode_image(). All calls have the same limits.
  core::Result<ImagePtr> decode(std::span<const std::uint8_t> bytes, const std::string& name,
                                const ImageLimits& limits);

 private:
  using Key = std::pair<std::uint64_t, std::size_t>;  // hash and number of the encoded bytes
  struct Entry {
    std::mutex decoding;
    std::weak_ptr<const Image> image;
  };
  void keep(const ImagePtr& image);

  const std::uint64_t kept_bytes_;
  std::mutex mutex_;  // guards all below, but not the content of entries
  std::map<Key, std::shared_ptr<Entry>> entries_;
  std::deque<ImagePtr> kept_;  // oldest first
  std::uint64_t bytes_ = 0;    // of kept_
};

}  // namespace psygen::image
