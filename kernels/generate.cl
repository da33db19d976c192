// Camera samples -> ray batch of generation 0, every weight 1.

#include "kernels/camera.h"
#include "kernels/ray_batch.h"

kernel void generate(const CameraConstants camera, const WaveConstants wave, global float* rays,
                     global uint* ray_ids, const uint capacity) {
    const ulong first = (ulong)wave.first_high << 32 | wave.first_low;
    const real3 eye = camera_vector(camera.eye, camera.eye_low);
    SAHL_FOR_EACH_GROUP(i, wave.count) {
        const CropPixels pixels = crop_pixels(&wave, first, i);
        const CameraSamples samples = camera_samples(&wave, first, i, &pixels);
        store_rays(all_lanes(), rays, ray_ids, capacity, i, same3(round3(eye)), same3_real(eye),
                   camera_directions(&camera, &samples), (uintv)(SAHL_NO_PRIMITIVE), (uintv)(SAHL_WORLD),
                   same3((float3)(1.0f)), pixels.y * wave.crop_width + pixels.x);
    }
}
