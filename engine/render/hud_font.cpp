#include "engine/render/hud_font.hpp"

#include <algorithm>

namespace psygen::render {
namespace {
#include "hud_font_baked.h"
}  // namespace

const HudFont& hud_font() {
  static const HudFont font{{kBakedWidth, kBakedHeight},
                            std::as_bytes(std::span(kBakedTexels)),
                            kBakedLetters,
                            kBakedEm,
                            kBakedAscent,
                            kBakedSpread};
  return font;
}

const BakedLetter& HudFont::letter(char32_t code) const {
  const auto find = [this](char32_t wanted) {
    const auto found = std::ranges::lower_bound(letters, wanted, {}, &BakedLetter::code);
    return found != letters.end() && found->code == wanted ? &*found : nullptr;
  };
  if (const BakedLetter* found = find(code)) return *found;
  const BakedLetter* const replacement = find(0xFFFD);
  return replacement != nullptr ? *replacement : letters.front();
}

}  // namespace psygen::render
