// PNG by libpng: what it holds, of 8 or 16 bits, becomes luminance (Rec. 709's weights, of the values as they
// are stored) times opacity.

#include "file/volume_reader.h"

#include "base/memory.h"

#include <png.h>
#include <setjmp.h>

typedef struct png_job {
    vn_bytes *bytes;
    vn_volume *volume;
    vn_status status; // why libpng was made to stop, when it was our doing
    size_t refused;   // bytes of the last allocation that failed: libpng calls that by many names
    png_structp png;
    png_infop info;
    png_bytep rows; // all of an interlaced picture; else one
    size_t row_size, row_count;
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
        job->status = job->refused > 0 ? vn_fail_memory("a PNG", job->refused)
                                       : vn_fail(VN_IO, "%s: is broken: libpng says \"%s\"",
                                                 vn_bytes_path(job->bytes), message);
    }
    png_longjmp(png, 1);
}

static void png_warned(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

static void png_fetch(png_structp png, png_bytep to, size_t count) {
    png_job *job = png_get_io_ptr(png);
    job->status = vn_bytes_take(job->bytes, to, count, "pixels");
    if (job->status != VN_OK) {
        png_error(png, "read");
    }
}

static void stop_on(png_job *job, vn_status status) {
    job->status = status;
    if (status != VN_OK) {
        png_error(job->png, "stopped");
    }
}

static uint32_t channel(const png_job *job, const png_byte *pixel, int number) {
    return job->volume->type == VN_VOXEL_U8 ? pixel[number]
                                            : (uint32_t)pixel[2 * number] << 8 | pixel[2 * number + 1];
}

static uint32_t gray_of(const png_job *job, const png_byte *pixel, int channels) {
    uint64_t white = job->volume->type == VN_VOXEL_U8 ? UINT8_MAX : UINT16_MAX;
    uint64_t gray = channel(job, pixel, 0);
    if (channels > 2) {
        gray = (2126 * gray + 7152 * (uint64_t)channel(job, pixel, 1) +
                722 * (uint64_t)channel(job, pixel, 2) + 5000) /
               10000;
    }
    if (channels % 2 == 0) {
        gray = (gray * channel(job, pixel, channels - 1) + white / 2) / white;
    }
    return (uint32_t)gray;
}

static void convert_row(png_job *job, const png_byte *row, size_t y) {
    size_t width = (size_t)job->volume->size[0];
    int channels = png_get_channels(job->png, job->info);
    size_t size = (size_t)channels * vn_voxel_size(job->volume->type);
    for (size_t x = 0; x < width; x++) {
        uint32_t gray = gray_of(job, row + x * size, channels);
        if (job->volume->type == VN_VOXEL_U8) {
            ((uint8_t *)job->volume->data)[y * width + x] = (uint8_t)gray;
        } else {
            ((uint16_t *)job->volume->data)[y * width + x] = (uint16_t)gray;
        }
    }
}

// Returns how often each row comes.
static int read_head(png_job *job) {
    vn_volume_head head = vn_volume_head_default();
    png_set_user_limits(job->png, INT32_MAX, INT32_MAX);
    png_read_info(job->png, job->info);
    head.size[0] = png_get_image_width(job->png, job->info);
    head.size[1] = png_get_image_height(job->png, job->info);
    stop_on(job, vn_bytes_check(job->bytes, head.size[1] * (double)png_get_rowbytes(job->png, job->info),
                                true, "pixels"));
    png_set_expand(job->png);
    int passes = png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
    bool wide = png_get_bit_depth(job->png, job->info) == 16;
    head.scalar = wide ? VN_SCALAR_U16 : VN_SCALAR_U8;
    head.white = wide ? UINT16_MAX : UINT8_MAX;
    vn_volume_head_flip(&head);
    stop_on(job, vn_volume_make(job->volume, job->bytes, &head));
    return passes;
}

static void make_rows(png_job *job, int passes) {
    job->row_count = passes > 1 ? (size_t)job->volume->size[1] : 1;
    job->row_size = png_get_rowbytes(job->png, job->info);
    size_t size = job->row_count * job->row_size;
    job->rows = vn_new_block(size);
    stop_on(job, job->rows != NULL ? VN_OK : vn_fail_memory("a PNG", size));
}

static void read_rows(png_job *job, int passes) {
    size_t height = (size_t)job->volume->size[1];
    for (int pass = 1; pass <= passes; pass++) {
        for (size_t y = 0; y < height; y++) {
            png_bytep row = job->rows + (job->row_count > 1 ? y : 0) * job->row_size;
            png_read_row(job->png, row, NULL);
            if (pass == passes) {
                convert_row(job, row, y);
            }
            stop_on(job, y % 256 == 0 ? vn_poll() : VN_OK);
        }
    }
}

// Everything that libpng may jump out of. No local variable lives across the jump.
static void decode(png_job *job) {
    if (setjmp(png_jmpbuf(job->png)) != 0) {
        return;
    }
    png_set_read_fn(job->png, job, png_fetch);
    job->info = png_create_info_struct(job->png);
    if (job->info == NULL) {
        png_error(job->png, "out of memory");
    }
    int passes = read_head(job);
    make_rows(job, passes);
    read_rows(job, passes);
    png_read_end(job->png, NULL);
}

vn_status vn_png_read(vn_volume *volume, vn_bytes *bytes) {
    png_job job = {.bytes = bytes, .volume = volume};
    job.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &job, png_failed, png_warned, &job, png_take,
                                       png_give_back);
    if (job.png == NULL) {
        return vn_fail_memory("a PNG", job.refused);
    }
    decode(&job);
    png_destroy_read_struct(&job.png, &job.info, NULL);
    vn_resize(job.rows, job.rows != NULL ? job.row_count * job.row_size : 0, 0);
    return job.status;
}
