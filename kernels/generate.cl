// Camera samples -> ray batch of generation 0, every weight 1.

#include "kernels/camera.h"
#include "kernels/ray_batch.h"

kernel void generate(const CameraConstants camera, const WaveConstants wave, global float* rays,
                     global uint* ray_ids, const uint capacity) {
    const ulong first = (ulong)wave.first_high << 32 | wave.first_low;
    const uint2 seed = (uint2)(wave.seed_low, wave.seed_high);
    const real3 eye = camera_vector(camera.eye, camera.eye_low);
    SAHL_FOR_EACH_GROUP(i, wave.count) {
        CameraSamples samples;
        uint pixels[SAHL_LANES];
        for (uint k = 0; k < SAHL_LANES; ++k) {
            const ulong sample = first + SAHL_MIN(i + k, wave.count - 1u);
            const uint2 pixel = crop_pixel((uint)(sample / wave.samples), wave.crop_width, wave.crop_height);
            const uint x = wave.crop_x + pixel.x, y = wave.crop_y + pixel.y;
            const uint in_job = wave.first_sample + (uint)(sample % wave.samples);
            const float2 in_pixel = pixel_sample(x, y, in_job, wave.spp, seed);
            pixels[k] = pixel.y * wave.crop_width + pixel.x;
            set_camera_sample(&samples, k, x, y, in_pixel);
        }
        store_rays(rays, ray_ids, capacity, i, same3(round3(eye)), same3_real(eye),
                   camera_directions(&camera, &samples), (uintv)(SAHL_NO_PRIMITIVE), (uintv)(SAHL_WORLD),
                   same3((float3)(1.0f)), vload8(0, pixels));
    }
}
