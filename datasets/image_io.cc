// SPDX-License-Identifier: MIT
#include "datasets/image_io.h"

#include <dlfcn.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>

#include "datasets/errors.h"
#include "datasets/image_planes.h"

namespace sketchsplat {
namespace {

constexpr char kExpected[] = "an image";

struct CloseFile {
  void operator()(FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<FILE, CloseFile>;

/// Opens a regular file that is not empty. Throws InputError.
File open_image(const std::string& path, size_t* size) {
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw InputError(path, kExpected, std::strerror(errno));
  struct stat status;
  if (::fstat(::fileno(file.get()), &status) != 0) {
    throw InputError(path, kExpected, std::strerror(errno));
  }
  if (S_ISDIR(status.st_mode)) throw InputError(path, kExpected, "a directory");
  if (!S_ISREG(status.st_mode)) throw InputError(path, kExpected, "no regular file");
  if (status.st_size == 0) throw InputError(path, kExpected, "an empty file");
  *size = size_t(status.st_size);
  return file;
}

bool is_png(FILE* file) {
  png_byte signature[8];
  const size_t n = std::fread(signature, 1, sizeof signature, file);
  std::rewind(file);
  return n == sizeof signature && png_sig_cmp(signature, 0, sizeof signature) == 0;
}

// ---------------------------------------------------------------------------------- libpng

/// libpng reports by longjmp. Everything that must outlive the jump sits here, outside of the
/// functions that call setjmp; those have no locals with destructors.
struct PngState {
  png_structp png = nullptr;
  png_infop info = nullptr;
  bool writing = false;
  char message[128] = "";
  std::vector<png_byte> rows;

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

template <typename T, int kChannels>
void append_row(const png_byte* row, float inverse, Planes* planes) {
  const int width = planes->width;
  float* out[kChannels];
  for (int c = 0; c < kChannels; ++c) {
    // Growing row by row keeps the zeros of resize() in the cache; all is reserved.
    std::vector<float>& plane = planes->plane[c];
    plane.resize(plane.size() + width);
    out[c] = plane.data() + plane.size() - width;
  }
  const T* in = reinterpret_cast<const T*>(row);
  for (int x = 0; x < width; ++x) {
    for (int c = 0; c < kChannels; ++c) out[c][x] = float(in[x * kChannels + c]) / inverse;
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
  for (int c = 0; c < planes->channels; ++c) {
    planes->plane[c].reserve(size_t(planes->width) * planes->height);
  }
  state->rows.resize(stride * (interlaced ? planes->height : 1));
  return true;
}

/// Decodes a whole file. Returns false with state->message.
bool decode_png(FILE* file, size_t file_size, PngState* state, Planes* planes) {
  png_structp png = state->png;
  png_infop info = state->info;
  if (setjmp(png_jmpbuf(png))) return false;
  png_init_io(png, file);
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
  if (!allocate(stored_bytes, file_size, stride, passes > 1, state, planes)) {
    std::snprintf(state->message, sizeof state->message, "more pixels than the file can hold");
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

bool encode_png(FILE* file, int width, int height, int channels, PngState* state) {
  static constexpr int kColorTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                        PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
  png_structp png = state->png;
  if (setjmp(png_jmpbuf(png))) return false;
  png_init_io(png, file);
  png_set_compression_level(png, 1);
  png_set_filter(png, 0, channels == 1 ? PNG_FILTER_NONE : PNG_FILTER_SUB);
  png_set_IHDR(png, state->info, width, height, 8, kColorTypes[channels - 1], PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, state->info);
  for (int y = 0; y < height; ++y) {
    png_write_row(png, state->rows.data() + size_t(y) * width * channels);
  }
  png_write_end(png, state->info);
  return true;
}

// -------------------------------------------------------------------------- everything else

/// The plug-in with OpenImageIO: beside the executable, where it is installed, or where it was
/// built.
ReadPlanes* load_plugin() {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& folder :
       {bin, bin / ".." / "lib" / "sketchsplat", fs::path(SKETCHSPLAT_PLUGIN_FOLDER)}) {
    if (void* library = ::dlopen((folder / kImagePluginFile).c_str(), RTLD_NOW | RTLD_LOCAL)) {
      return reinterpret_cast<ReadPlanes*>(::dlsym(library, kReadPlanesSymbol));
    }
  }
  return nullptr;
}

Planes read_by_plugin(const std::string& path, bool header_only) {
  static ReadPlanes* const read = load_plugin();
  if (!read)
    throw InputError(path, std::string("a PNG image (no ") + kImagePluginFile + " here)",
                     "another file");
  Planes planes;
  std::string found;
  if (!read(path.c_str(), header_only, &planes, &found)) throw InputError(path, kExpected, found);
  return planes;
}

Planes read_planes(const std::string& path) {
  size_t size = 0;
  const File file = open_image(path, &size);
  if (!is_png(file.get())) return read_by_plugin(path, false);
  PngState state(false);
  Planes planes;
  try {
    if (decode_png(file.get(), size, &state, &planes)) return planes;
  } catch (const std::bad_alloc&) {
    throw InputError(path, "an image that fits into memory", "a larger one");
  }
  throw InputError(path, "a whole PNG image", std::string("a broken one (") + state.message + ")");
}

// ---------------------------------------------------------------------------------- writing

void write_planes(const std::string& path, int width, int height,
                  const std::vector<const float*>& planes) {
  if (width <= 0 || height <= 0) throw OutputError(path, "an image without pixels");
  PngState state(true);
  const size_t channels = planes.size();
  state.rows.resize(size_t(width) * height * channels);
  for (size_t c = 0; c < channels; ++c) {
    for (size_t i = 0; i < size_t(width) * height; ++i) {
      const float v = planes[c][i] > 0 ? std::min(planes[c][i], 1.0f) : 0.0f;
      state.rows[i * channels + c] = png_byte(v * 255.0f + 0.5f);
    }
  }
  const std::string part = path + "." + std::to_string(::getpid()) + ".part";
  FILE* file = std::fopen(part.c_str(), "wb");
  if (!file) throw OutputError(path, std::strerror(errno));
  std::string found;
  if (!encode_png(file, width, height, int(channels), &state)) found = state.message;
  if (std::fclose(file) != 0 && found.empty()) found = std::strerror(errno);
  if (found.empty() && std::rename(part.c_str(), path.c_str()) != 0) found = std::strerror(errno);
  if (found.empty()) return;
  std::remove(part.c_str());
  throw OutputError(path, found);
}

Image<float> as_image(int width, int height, std::vector<float> data) {
  Image<float> image;
  image.width = width;
  image.height = height;
  image.data = std::move(data);
  return image;
}

}  // namespace

Picture read_picture(const std::string& path) {
  Planes p = read_planes(path);
  const bool grey = p.channels <= 2;
  Picture picture;
  if (p.channels % 2 == 0)
    picture.alpha = as_image(p.width, p.height, std::move(p.plane[p.channels - 1]));
  picture.red = as_image(p.width, p.height, std::move(p.plane[0]));
  picture.green = grey ? picture.red : as_image(p.width, p.height, std::move(p.plane[1]));
  picture.blue = grey ? picture.red : as_image(p.width, p.height, std::move(p.plane[2]));
  return picture;
}

Image<float> read_grey(const std::string& path) {
  Planes p = read_planes(path);
  std::vector<float>& grey = p.plane[0];
  if (p.channels >= 3) {
    for (size_t i = 0; i < grey.size(); ++i) {
      grey[i] = (grey[i] + p.plane[1][i] + p.plane[2][i]) / 3.0f;
    }
  }
  return as_image(p.width, p.height, std::move(grey));
}

ImageSize read_image_size(const std::string& path) {
  size_t size = 0;
  const File file = open_image(path, &size);
  if (!is_png(file.get())) {
    const Planes planes = read_by_plugin(path, true);
    return {planes.width, planes.height};
  }
  // The first chunk of a PNG file is IHDR, which begins with width and height.
  png_byte head[24];
  if (std::fread(head, 1, sizeof head, file.get()) != sizeof head ||
      std::memcmp(head + 12, "IHDR", 4) != 0) {
    throw InputError(path, "a whole PNG image", "a broken one (no header)");
  }
  const png_uint_32 width = png_get_uint_32(head + 16), height = png_get_uint_32(head + 20);
  if (width == 0 || height == 0 || width > PNG_UINT_31_MAX || height > PNG_UINT_31_MAX) {
    throw InputError(path, "a whole PNG image", "a broken one (no size)");
  }
  return {int(width), int(height)};
}

void write_png(const std::string& path, const Image<float>& grey) {
  write_planes(path, grey.width, grey.height, {grey.data.data()});
}

void write_png(const std::string& path, const Picture& picture) {
  std::vector<const float*> planes = {picture.red.data.data(), picture.green.data.data(),
                                      picture.blue.data.data()};
  if (!picture.alpha.empty()) planes.push_back(picture.alpha.data.data());
  write_planes(path, picture.width(), picture.height(), planes);
}

}  // namespace sketchsplat
