// Runs at build time: bakes the letters of a TrueType font into signed distances, from which text
// of any size is drawn sharply (Green, "Improved Alpha-Tested Magnification", SIGGRAPH 2007).
// Writes a C++ header with one texture and the metrics of each letter;
// engine/render/text/hud_layout.cpp includes it.
//
// usage: bake_font FONT.ttf OUTPUT.h
#include <stb/stb_rect_pack.h>
#include <stb/stb_truetype.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

namespace {

constexpr float kEmPixels = 48;  // of the texture, from ascender to descender
constexpr int kSpread = 6;       // pixels of distance around an edge
constexpr int kWidth = 1000;     // of the texture
constexpr int kMaxRows = 2000;
constexpr unsigned char kEdge = 128;

// Latin with all European letters, punctuation, a few arrows and signs.
constexpr std::pair<int, int> kRanges[] = {
    {0x20, 0x7E},     {0xA0, 0x17F},    {0x192, 0x192},   {0x1CD, 0x1DC},   {0x218, 0x21B},
    {0x2C6, 0x2C7},   {0x2D8, 0x2DD},   {0x1E9E, 0x1E9E}, {0x2010, 0x2015}, {0x2018, 0x201E},
    {0x2020, 0x2022}, {0x2026, 0x2026}, {0x2030, 0x2030}, {0x2032, 0x2033}, {0x2039, 0x203A},
    {0x20AC, 0x20AC}, {0x2122, 0x2122}, {0x2190, 0x2195}, {0x2212, 0x2212}, {0x221E, 0x221E},
    {0x2248, 0x2248}, {0x2260, 0x2260}, {0x2264, 0x2265}, {0x25A0, 0x25A1}, {0x25B2, 0x25B2},
    {0x25B6, 0x25B6}, {0x25BC, 0x25BC}, {0x25C0, 0x25C0}, {0x25CF, 0x25CF}, {0x2605, 0x2606},
    {0x2665, 0x2665}, {0x2713, 0x2713}, {0x2717, 0x2717}, {0xFFFD, 0xFFFD}};

struct Letter {
  int code = 0, advance = 0, x = 0, y = 0, width = 0, height = 0;
  unsigned char* distances = nullptr;  // of stb
};

[[noreturn]] void fail(const char* file, const char* reason) {
  std::fprintf(stderr, "bake_font: %s: %s\n", file, reason);
  std::exit(1);
}

void write_bytes(std::ofstream& out, const std::vector<unsigned char>& texels) {
  for (std::size_t i = 0; i < texels.size(); ++i)
    out << static_cast<int>(texels[i]) << (i % 32 == 31 ? ",\n" : ",");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) fail("usage", "bake_font FONT.ttf OUTPUT.h");
  std::ifstream file(arguments[1], std::ios::binary);
  const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), {}};
  stbtt_fontinfo font;
  if (bytes.empty() || stbtt_InitFont(&font, bytes.data(), 0) == 0)
    fail(arguments[1], "this is not a TrueType font");
  const float scale = stbtt_ScaleForPixelHeight(&font, kEmPixels);
  int ascent = 0, descent = 0, gap = 0;
  stbtt_GetFontVMetrics(&font, &ascent, &descent, &gap);

  std::vector<Letter> letters;
  std::vector<stbrp_rect> places;
  for (const auto& [first, last] : kRanges) {
    for (int code = first; code <= last; ++code) {
      const int glyph = stbtt_FindGlyphIndex(&font, code);
      if (glyph == 0) continue;
      Letter letter{.code = code};
      stbtt_GetGlyphHMetrics(&font, glyph, &letter.advance, nullptr);
      letter.distances = stbtt_GetGlyphSDF(&font, scale, glyph, kSpread, kEdge,
                                           static_cast<float>(kEdge) / kSpread, &letter.width,
                                           &letter.height, &letter.x, &letter.y);
      stbrp_rect place{};
      place.id = static_cast<int>(letters.size());
      place.w = static_cast<stbrp_coord>(letter.width);
      place.h = static_cast<stbrp_coord>(letter.height);
      letters.push_back(letter);
      places.push_back(place);
    }
  }
  stbrp_context packer;
  std::vector<stbrp_node> nodes(kWidth);
  stbrp_init_target(&packer, kWidth, kMaxRows, nodes.data(), kWidth);
  if (stbrp_pack_rects(&packer, places.data(), static_cast<int>(places.size())) == 0)
    fail(arguments[1], "its letters need a larger texture");
  int rows = 0;
  for (const stbrp_rect& place : places)
    rows = std::max(rows, static_cast<int>(place.y) + static_cast<int>(place.h));

  std::vector<unsigned char> texels(static_cast<std::size_t>(kWidth) *
                                    static_cast<std::size_t>(rows));
  std::ofstream out(arguments[2]);
  out << std::showpoint << "// Written by bake_font.\n"
      << "constexpr int kBakedWidth = " << kWidth << ", kBakedHeight = " << rows << ";\n"
      << "constexpr float kBakedEm = " << kEmPixels << "F, kBakedSpread = " << kSpread
      << ", kBakedAscent = " << static_cast<float>(ascent) * scale << "F;\n"
      << "constexpr BakedLetter kBakedLetters[] = {\n";
  for (const stbrp_rect& place : places) {
    const Letter& letter = letters[static_cast<std::size_t>(place.id)];
    for (int y = 0; y < letter.height; ++y) {
      std::copy_n(letter.distances + y * letter.width, letter.width,
                  texels.begin() + (place.y + y) * kWidth + place.x);
    }
    out << "{" << letter.code << "," << static_cast<float>(letter.advance) * scale << "F,"
        << letter.x << "," << letter.y << "," << letter.width << "," << letter.height << ","
        << place.x << "," << place.y << "},\n";
    stbtt_FreeSDF(letter.distances, nullptr);
  }
  out << "};\nconstexpr unsigned char kBakedTexels[] = {\n";
  write_bytes(out, texels);
  out << "};\n";
  return out.flush() ? 0 : (std::fprintf(stderr, "bake_font: cannot write %s\n", arguments[2]), 1);
}
