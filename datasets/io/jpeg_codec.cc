// SPDX-License-Identifier: MIT
#include "datasets/io/jpeg_codec.h"

#include <jpeglib.h>  // needs <cstdio> before it
// and jerror.h needs this
#include <jerror.h>

#include <csetjmp>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

namespace sketchsplat {
namespace {

/// libjpeg reports by a function that must not return. Everything that must outlive the jump sits
/// here, outside of the functions that call setjmp; those have no locals with destructors.
struct JpegState {
  jpeg_decompress_struct jpeg;
  jpeg_error_mgr errors;
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX] = "";
  std::vector<JSAMPLE> row;

  JpegState() {
    jpeg.err = jpeg_std_error(&errors);
    errors.error_exit = on_error;
    errors.emit_message = on_message;
    jpeg.client_data = this;
    jpeg_create_decompress(&jpeg);
  }
  ~JpegState() { jpeg_destroy_decompress(&jpeg); }
  JpegState(const JpegState&) = delete;

 private:
  static void on_error(j_common_ptr jpeg) {
    JpegState* state = static_cast<JpegState*>(jpeg->client_data);
    state->errors.format_message(jpeg, state->message);
    std::longjmp(state->escape, 1);
  }
  /// Where data are missing libjpeg makes up grey and goes on.
  static void on_message(j_common_ptr jpeg, int) {
    const int code = jpeg->err->msg_code;
    if (code == JWRN_HIT_MARKER || code == JWRN_JPEG_EOF) on_error(jpeg);
  }
};

bool read_header(JpegState* state) {
  if (setjmp(state->escape)) return false;
  return jpeg_read_header(&state->jpeg, TRUE) == JPEG_HEADER_OK;
}

template <int kChannels>
void append_row(const JSAMPLE* in, Planes* planes) {
  for (int c = 0; c < kChannels; ++c) {
    std::vector<float>& plane = planes->plane[c];
    plane.resize(plane.size() + planes->width);
    float* out = plane.data() + plane.size() - planes->width;
    for (int x = 0; x < planes->width; ++x) out[x] = float(in[x * kChannels + c]) / 255.0f;
  }
}

bool decode(JpegState* state, size_t file_size, int denominator, Planes* planes) {
  jpeg_decompress_struct& jpeg = state->jpeg;
  if (setjmp(state->escape)) return false;
  // The first scan spends at least one bit on a block of 8 x 8 pixels: a header that promises more
  // is broken and must not make us allocate.
  if (size_t(jpeg.image_width) * jpeg.image_height / 1024 > file_size) {
    std::snprintf(state->message, sizeof state->message, "more pixels than the file can hold");
    return false;
  }
  if (std::int64_t(jpeg.image_width) * jpeg.image_height > kMostPixels) {
    std::snprintf(state->message, sizeof state->message, "too many pixels");
    return false;
  }
  jpeg.out_color_space = jpeg.jpeg_color_space == JCS_GRAYSCALE ? JCS_GRAYSCALE : JCS_RGB;
  jpeg.scale_num = 1;
  jpeg.scale_denom = denominator;
  jpeg_start_decompress(&jpeg);
  planes->width = int(jpeg.output_width);
  planes->height = int(jpeg.output_height);
  planes->channels = jpeg.output_components;
  for (int c = 0; c < planes->channels; ++c)
    planes->plane[c].reserve(size_t(planes->width) * planes->height);
  state->row.resize(size_t(planes->width) * planes->channels);
  JSAMPROW row = state->row.data();
  while (jpeg.output_scanline < jpeg.output_height) {
    jpeg_read_scanlines(&jpeg, &row, 1);
    planes->channels == 1 ? append_row<1>(row, planes) : append_row<3>(row, planes);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

}  // namespace

bool decode_jpeg(const std::string& bytes, int denominator, Planes* planes, std::string* found) {
  JpegState state;
  jpeg_mem_src(&state.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  if (!read_header(&state)) {
    *found = state.message;
    return false;
  }
  const J_COLOR_SPACE colours = state.jpeg.jpeg_color_space;
  if (colours == JCS_CMYK || colours == JCS_YCCK) return false;
  try {
    if (decode(&state, bytes.size(), denominator, planes)) return true;
    *found = state.message;
  } catch (const std::bad_alloc&) {
    *found = "too large for the memory";
  }
  return false;
}

namespace {

/// As JpegState, the other way round. `bytes` is libjpeg's, by malloc.
struct JpegWriter {
  jpeg_compress_struct jpeg;
  jpeg_error_mgr errors;
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX] = "";
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  JpegWriter() {
    jpeg.err = jpeg_std_error(&errors);
    errors.error_exit = [](j_common_ptr failed) {
      JpegWriter* writer = static_cast<JpegWriter*>(failed->client_data);
      writer->errors.format_message(failed, writer->message);
      std::longjmp(writer->escape, 1);
    };
    jpeg.client_data = this;
    jpeg_create_compress(&jpeg);
  }
  ~JpegWriter() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }
  JpegWriter(const JpegWriter&) = delete;
};

bool encode(const unsigned char* rows, int width, int height, int quality, JpegWriter* writer) {
  jpeg_compress_struct& jpeg = writer->jpeg;
  if (setjmp(writer->escape)) return false;
  jpeg_mem_dest(&jpeg, &writer->bytes, &writer->size);
  jpeg.image_width = JDIMENSION(width);
  jpeg.image_height = JDIMENSION(height);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg.optimize_coding = TRUE;
  jpeg_start_compress(&jpeg, TRUE);
  while (jpeg.next_scanline < jpeg.image_height) {
    JSAMPROW row = const_cast<JSAMPLE*>(rows) + size_t(jpeg.next_scanline) * width * 3;
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  return true;
}

}  // namespace

bool encode_jpeg(const unsigned char* rows, int width, int height, int quality, std::string* bytes,
                 std::string* found) {
  JpegWriter writer;
  if (!encode(rows, width, height, quality, &writer)) {
    *found = writer.message;
    return false;
  }
  bytes->assign(reinterpret_cast<const char*>(writer.bytes), writer.size);
  return true;
}

bool jpeg_size(FILE* file, int* width, int* height) {
  JpegState state;
  jpeg_stdio_src(&state.jpeg, file);
  if (!read_header(&state)) return false;
  *width = int(state.jpeg.image_width);
  *height = int(state.jpeg.image_height);
  return true;
}

}  // namespace sketchsplat
