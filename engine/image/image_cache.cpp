#include "engine/image/image_cache.hpp"

#include "engine/core/hash.hpp"

namespace psygen::image {

core::Result<ImagePtr> ImageCache::decode(std::span<const std::uint8_t> bytes,
                                          const std::string& name, const ImageLimits& limits) {
  const Key key{core::hash_bytes(std::as_bytes(bytes)), bytes.size()};
  std::unique_lock lock(mutex_);
  std::shared_ptr<Entry>& known = entries_[key];
  if (!known) known = std::make_shared<Entry>();
  const std::shared_ptr<Entry> entry = known;
  lock.unlock();
  const std::lock_guard decoding(entry->decoding);
  if (auto image = entry->image.lock()) return image;
  auto decoded = decode_image(bytes, name, limits);
  if (!decoded) return tl::unexpected(decoded.error());
  auto image = std::make_shared<const Image>(std::move(*decoded));
  entry->image = image;
  keep(image);
  return image;
}

void ImageCache::keep(const ImagePtr& image) {
  const std::lock_guard lock(mutex_);
  kept_.push_back(image);
  bytes_ += image->rgba.size();
  while (bytes_ > kept_bytes_) {
    bytes_ -= kept_.front()->rgba.size();
    kept_.pop_front();
  }
}

}  // namespace psygen::image
