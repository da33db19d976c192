// Camera samples -> ray batch of generation 0, every weight 1.

#include "kernels/camera.h"
#include "kernels/ray_batch.h"

kernel void generate(const CameraConstants camera, const WaveConstants wave, global float* rays, global uint* ray_ids,
                     const uint capacity) {
    const ulong first = (ulong)wave.first_high << 32 | wave.first_low;
    const uint2 seed = (uint2)(wave.seed_low, wave.seed_high);
    SAHL_FOR_EACH_RAY(i, wave.count) {
        ulong sample = first + i;
        uint2 pixel = crop_pixel((uint)(sample / wave.spp), wave.crop_width, wave.crop_height);
        uint x = wave.crop_x + pixel.x, y = wave.crop_y + pixel.y;
        float2 in_pixel = pixel_sample(x, y, (uint)(sample % wave.spp), wave.spp, seed);
        Ray ray;
        ray.origin = (float3)(camera.eye[0], camera.eye[1], camera.eye[2]);
        ray.direction = camera_direction(&camera, (float2)((float)x, (float)y) + in_pixel);
        ray.exclude = SAHL_NO_PRIMITIVE;
        store_ray(rays, ray_ids, capacity, i, ray, (float3)(1.0f), pixel.y * wave.crop_width + pixel.x);
    }
}
