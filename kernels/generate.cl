// Camera samples -> ray batch of generation 0, every weight 1.

#include "kernels/camera.h"
#include "kernels/ray_batch.h"

kernel void generate(const CameraConstants camera, const WaveConstants wave, global float* rays,
                     global uint* ray_ids, const uint capacity) {
    const ulong first = (ulong)wave.first_high << 32 | wave.first_low;
    const uint2 seed = (uint2)(wave.seed_low, wave.seed_high);
    SAHL_FOR_EACH_RAY(i, wave.count) {
        ulong sample = first + i;
        uint2 pixel = crop_pixel((uint)(sample / wave.samples), wave.crop_width, wave.crop_height);
        uint x = wave.crop_x + pixel.x, y = wave.crop_y + pixel.y;
        uint in_job = wave.first_sample + (uint)(sample % wave.samples);
        float2 in_pixel = pixel_sample(x, y, in_job, wave.spp, seed);
        real3 eye = camera_vector(camera.eye, camera.eye_low);
        store_ray(rays, ray_ids, capacity, i, round3(eye), eye, camera_direction(&camera, x, y, in_pixel),
                  SAHL_NO_PRIMITIVE, SAHL_WORLD, (float3)(1.0f), pixel.y * wave.crop_width + pixel.x);
    }
}
