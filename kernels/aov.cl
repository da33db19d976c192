// First hits of camera rays -> AOVs, in the rays' order.

#include "kernels/camera.h"
#include "kernels/ray_batch.h"
#include "kernels/surface.h"
#include "kernels/texture.h"

kernel void describe(const global DevicePrimitive* primitives, const global float* shape_data,
                     const global DeviceInstance* instances, const global DeviceMaterial* materials,
                     const global DeviceTexture* textures, const CameraConstants camera,
                     const global float* rays, const global float* hits, const global uint* hit_ids,
                     global float* values, global uint* ids, const uint capacity, const uint count) {
    const Shapes shapes = {primitives, shape_data, instances};
    SAHL_FOR_EACH_RAY(i, count) {
        const uint primitive = hit_ids[(size_t)SAHL_HIT_PRIMITIVE * capacity + i];
        const uint instance = hit_ids[(size_t)SAHL_HIT_INSTANCE * capacity + i];
        float depth = INFINITY;
        float3 normal = (float3)(0.0f), albedo = (float3)(0.0f);
        uint material_id = SAHL_AOV_NO_ID;
        if (primitive != SAHL_NO_PRIMITIVE) {
            const real3 d = load_soa3_real(rays, SAHL_RAY_DIRECTION, SAHL_RAY_DIRECTION_LOW, capacity, i);
            const real3 origin = load_soa3_real(rays, SAHL_RAY_ORIGIN, SAHL_RAY_ORIGIN_LOW, capacity, i);
            const float3 hit = load_soa3(hits, SAHL_HIT_T, capacity, i);
            const Surface surface = surface_at(&shapes, instance, primitive, origin, d, hit.x, hit.y, hit.z);
            const global DeviceMaterial* material = materials + surface.material;
            const bool turned =
                (material->flags & SAHL_MATERIAL_TWO_SIDED) && dot3_real(surface.ns, d) > (real)0;
            depth = (float)(surface.t * dot3_real(d, camera_vector(camera.forward, camera.forward_low)));
            normal = round3(turned ? -surface.ns : surface.ns);
            albedo = surface_colors(&shapes, material, textures, &surface, primitive).diffuse;
            material_id = surface.material;
        }
        values[(size_t)SAHL_AOV_DEPTH * capacity + i] = depth;
        store_soa3(values, SAHL_AOV_NORMAL, capacity, i, normal);
        store_soa3(values, SAHL_AOV_ALBEDO, capacity, i, albedo);
        ids[(size_t)SAHL_AOV_PRIMITIVE * capacity + i] =
            primitive == SAHL_NO_PRIMITIVE ? SAHL_AOV_NO_ID : primitive;
        ids[(size_t)SAHL_AOV_INSTANCE * capacity + i] =
            primitive == SAHL_NO_PRIMITIVE ? SAHL_AOV_NO_ID : instance;
        ids[(size_t)SAHL_AOV_MATERIAL * capacity + i] = material_id;
    }
}
