// SPDX-License-Identifier: MIT
#include "datasets/io/png_codec.h"

#include <png.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

namespace sketchsplat {
namespace {

/// libpng reports by longjmp. Everything that must outlive the jump sits here, outside of the
/// functions that call setjmp; those have no locals with destructors.
struct PngState {
  png_structp png = nullptr;
  png_infop info = nullptr;
  bool writing = false;
  char message[128] = "";
  std::vector<png_byte> rows;
  const std::string* in = nullptr;  // the file that is read
  size_t at = 0;                    // in it

  explicit PngState(bool write) : writing(write) {
    png = write ? png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)
                : png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png) info = png_create_info_struct(png);
    if (!info) throw std::bad_alloc();
  }
  ~PngState() {
    if (writing) {
      png_destroy_write_struct(&png, &info);
    } else {
      png_destroy_read_struct(&png, &info, nullptr);
    }
  }
  PngState(const PngState&) = delete;

 private:
  static void on_error(png_structp png, png_const_charp message) {
    PngState* state = static_cast<PngState*>(png_get_error_ptr(png));
    std::snprintf(state->message, sizeof state->message, "%s", message);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
};

void read_bytes(png_structp png, png_bytep bytes, size_t count) {
  PngState* state = static_cast<PngState*>(png_get_io_ptr(png));
  if (count > state->in->size() - state->at) png_error(png, "Read Error");
  std::memcpy(bytes, state->in->data() + state->at, count);
  state->at += count;
}

void write_bytes(png_structp png, png_bytep bytes, size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
}

template <typename T, int kChannels>
void append_row(const png_byte* row, float largest, Planes* planes) {
  const int width = planes->width;
  const T* in = reinterpret_cast<const T*>(row);
  for (int c = 0; c < kChannels; ++c) {
    // Growing row by row keeps the zeros of resize() in the cache; all is reserved.
    std::vector<float>& plane = planes->plane[c];
    plane.resize(plane.size() + width);
    float* out = plane.data() + plane.size() - width;
    for (int x = 0; x < width; ++x) out[x] = float(in[x * kChannels + c]) / largest;
  }
}

template <typename T>
void append_row(const png_byte* row, Planes* planes) {
  constexpr float kMax = float(T(-1));
  switch (planes->channels) {
    case 1:
      return append_row<T, 1>(row, kMax, planes);
    case 2:
      return append_row<T, 2>(row, kMax, planes);
    case 3:
      return append_row<T, 3>(row, kMax, planes);
    default:
      return append_row<T, 4>(row, kMax, planes);
  }
}

/// Makes room for the planes. Deflate cannot shrink by more than 1032: a header that promises more
/// is broken and must not make us allocate.
bool allocate(size_t stored_bytes, size_t file_size, size_t stride, bool interlaced,
              PngState* state, Planes* planes) {
  if (stored_bytes / 1100 > file_size) return false;
  if (std::int64_t(planes->width) * planes->height > kMostPixels) return false;
  for (int c = 0; c < planes->channels; ++c) {
    planes->plane[c].reserve(size_t(planes->width) * planes->height);
  }
  state->rows.resize(stride * (interlaced ? planes->height : 1));
  return true;
}

bool decode(PngState* state, Planes* planes) {
  png_structp png = state->png;
  png_infop info = state->info;
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_read_fn(png, state, read_bytes);
  png_set_option(png, PNG_IGNORE_ADLER32, PNG_OPTION_ON);  // each chunk has a checksum of its own
  png_read_info(png, info);
  planes->width = int(png_get_image_width(png, info));
  planes->height = int(png_get_image_height(png, info));
  const size_t stored_bytes = png_get_rowbytes(png, info) * planes->height;
  png_set_expand(png);  // palette, 1 to 4 bit, transparent colour
  const int one = 1;
  if (*reinterpret_cast<const char*>(&one)) png_set_swap(png);
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  planes->channels = png_get_channels(png, info);
  const bool deep = png_get_bit_depth(png, info) == 16;
  const size_t stride = png_get_rowbytes(png, info);
  if (!allocate(stored_bytes, state->in->size(), stride, passes > 1, state, planes)) {
    std::snprintf(state->message, sizeof state->message,
                  "more pixels than the file can hold, or too many");
    return false;
  }
  for (int pass = 0; pass < passes; ++pass) {
    for (int y = 0; y < planes->height; ++y) {
      png_bytep row = state->rows.data() + (passes > 1 ? y * stride : 0);
      png_read_row(png, row, nullptr);
      if (pass + 1 < passes) continue;
      deep ? append_row<png_uint_16>(row, planes) : append_row<png_byte>(row, planes);
    }
  }
  png_read_end(png, nullptr);
  return true;
}

bool encode(const png_byte* rows, int width, int height, int channels, std::string* bytes,
            PngState* state) {
  static constexpr int kColorTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                        PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
  png_structp png = state->png;
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, bytes, write_bytes, nullptr);
  png_set_compression_level(png, 1);
  png_set_filter(png, 0, channels == 1 ? PNG_FILTER_NONE : PNG_FILTER_SUB);
  png_set_IHDR(png, state->info, width, height, 8, kColorTypes[channels - 1], PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, state->info);
  for (int y = 0; y < height; ++y) {
    png_write_row(png, rows + size_t(y) * width * channels);
  }
  png_write_end(png, state->info);
  return true;
}

}  // namespace

bool decode_png(const std::string& file, Planes* planes, std::string* found) {
  try {
    PngState state(false);
    state.in = &file;
    if (decode(&state, planes)) return true;
    *found = state.message;
  } catch (const std::bad_alloc&) {
    *found = "too large for the memory";
  }
  return false;
}

bool png_size(const std::string& file, int* width, int* height) {
  // Signature, then the chunk IHDR, which begins with width and height.
  if (file.size() < 24) return false;
  const png_byte* head = reinterpret_cast<const png_byte*>(file.data());
  const png_uint_32 w = png_get_uint_32(head + 16), h = png_get_uint_32(head + 20);
  *width = int(w);
  *height = int(h);
  return std::memcmp(head + 12, "IHDR", 4) == 0 && w > 0 && h > 0 && w <= PNG_UINT_31_MAX &&
         h <= PNG_UINT_31_MAX;
}

bool encode_png(const unsigned char* rows, int width, int height, int channels, std::string* bytes,
                std::string* found) {
  PngState state(true);
  if (encode(rows, width, height, channels, bytes, &state)) return true;
  *found = state.message;
  return false;
}

}  // namespace sketchsplat
