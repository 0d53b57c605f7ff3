#include "draw/png_writer.h"

#include "base/memory.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>

typedef struct png_job {
    vn_sink *sink;
    const vn_pixels *pixels;
    const char *manifest;
    vn_status status; // why libpng was made to stop, when it was our doing
    size_t refused;   // bytes of the last allocation that failed: libpng calls that by many names
    png_structp png;
    png_infop info;
    png_bytep row;
    size_t row_size;
    bool opaque;
} png_job;

static png_voidp png_take(png_structp png, png_alloc_size_t size) {
    void *block = vn_sized_block(size);
    if (block == NULL) {
        png_job *job = png_get_mem_ptr(png);
        job->refused = size;
    }
    return block;
}

static void png_give_back(png_structp png, png_voidp block) {
    (void)png;
    vn_free_sized(block);
}

static void png_failed(png_structp png, png_const_charp message) {
    png_job *job = png_get_error_ptr(png);
    if (job->status == VN_OK) {
        job->status = job->refused > 0
                          ? vn_fail_memory("a PNG", job->refused)
                          : vn_fail(VN_EXTERNAL, "libpng could not write the picture: %s", message);
    }
    png_longjmp(png, 1);
}

static void png_warned(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

static void png_send(png_structp png, png_bytep bytes, size_t count) {
    png_job *job = png_get_io_ptr(png);
    job->status = vn_sink_write(job->sink, bytes, count);
    if (job->status != VN_OK) {
        png_error(png, "write");
    }
}

static void png_flushed(png_structp png) {
    (void)png;
}

static bool all_opaque(const vn_pixels *pixels) {
    size_t count = (size_t)pixels->width * (size_t)pixels->height;
    for (size_t i = 0; i < count; i++) {
        if (pixels->data[i] >> 24 != 255) {
            return false;
        }
    }
    return true;
}

static png_byte straight(uint32_t channel, uint32_t alpha) {
    uint32_t value = (channel * 255 + alpha / 2) / alpha;
    return (png_byte)(value < 255 ? value : 255);
}

static void convert_row(png_job *job, const uint32_t *pixels) {
    png_bytep at = job->row;
    for (int32_t x = 0; x < job->pixels->width; x++) {
        uint32_t pixel = pixels[x];
        uint32_t alpha = pixel >> 24;
        *at++ = alpha > 0 ? straight(pixel >> 16 & 255, alpha) : 0;
        *at++ = alpha > 0 ? straight(pixel >> 8 & 255, alpha) : 0;
        *at++ = alpha > 0 ? straight(pixel & 255, alpha) : 0;
        if (!job->opaque) {
            *at++ = (png_byte)alpha;
        }
    }
}

static bool is_ascii(const char *text) {
    while (*text != '\0' && (unsigned char)*text < 0x80) {
        text++;
    }
    return *text == '\0';
}

static void set_text(png_job *job) {
    char key[] = "venule";
    png_text text = {.key = key, .text = (png_charp)job->manifest};
    text.compression = is_ascii(job->manifest) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    png_set_text(job->png, job->info, &text, 1);
}

static void write_head(png_job *job) {
    const vn_pixels *pixels = job->pixels;
    png_set_IHDR(job->png, job->info, (png_uint_32)pixels->width, (png_uint_32)pixels->height, 8,
                 job->opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    double a_meter = floor(pixels->a_meter + 0.5);
    if (a_meter >= 1 && a_meter <= INT32_MAX) {
        png_set_pHYs(job->png, job->info, (png_uint_32)a_meter, (png_uint_32)a_meter, PNG_RESOLUTION_METER);
    }
    if (job->manifest != NULL) {
        set_text(job);
    }
    png_write_info(job->png, job->info);
}

static void write_rows(png_job *job) {
    const vn_pixels *pixels = job->pixels;
    for (int32_t y = 0; y < pixels->height; y++) {
        convert_row(job, pixels->data + (size_t)y * (size_t)pixels->width);
        png_write_row(job->png, job->row);
        job->status = y % 256 == 0 ? vn_poll() : VN_OK;
        if (job->status != VN_OK) {
            png_error(job->png, "stopped");
        }
    }
}

// Everything that libpng may jump out of. No local variable lives across the jump.
static void encode(png_job *job) {
    if (setjmp(png_jmpbuf(job->png)) != 0) {
        return;
    }
    png_set_write_fn(job->png, job, png_send, png_flushed);
    job->info = png_create_info_struct(job->png);
    if (job->info == NULL) {
        png_error(job->png, "out of memory");
    }
    write_head(job);
    write_rows(job);
    png_write_end(job->png, NULL);
}

vn_status vn_png_write(vn_sink *sink, const vn_pixels *pixels, const char *manifest) {
    png_job job = {.sink = sink, .pixels = pixels, .manifest = manifest, .opaque = all_opaque(pixels)};
    job.row_size = (size_t)pixels->width * (job.opaque ? 3 : 4);
    job.row = vn_resize(NULL, 0, job.row_size);
    if (job.row == NULL) {
        return vn_fail_memory("a PNG", job.row_size);
    }
    job.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &job, png_failed, png_warned, &job, png_take,
                                        png_give_back);
    if (job.png == NULL) {
        job.status = vn_fail_memory("a PNG", job.row_size);
    } else {
        encode(&job);
        png_destroy_write_struct(&job.png, &job.info);
    }
    vn_resize(job.row, job.row_size, 0);
    return job.status;
}
