#include "engine/app/virtual_frame.hpp"

namespace psygen::app {

double virtual_frame_ms(std::uint64_t triangles, std::uint32_t draws, core::Extent size,
                        double resolution) {
  const double pixels =
      static_cast<double>(size.width) * static_cast<double>(size.height) * resolution * resolution;
  return kVirtualFrameMs + kVirtualTriangleMs * static_cast<double>(triangles) +
         kVirtualDrawMs * static_cast<double>(draws) + kVirtualPixelMs * pixels;
}

}  // namespace psygen::app
