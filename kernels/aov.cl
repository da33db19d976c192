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
    const realv3 forward = same3_real(camera_vector(camera.forward, camera.forward_low));
    SAHL_FOR_EACH_GROUP(i, count) {
        const uintv hit_primitive = load_idsv(hit_ids, SAHL_HIT_PRIMITIVE, capacity, i);
        const uintv instance = load_idsv(hit_ids, SAHL_HIT_INSTANCE, capacity, i);
        const intv hit = (lane_numbers() < (intv)((int)(count - i))) & (hit_primitive != SAHL_NO_PRIMITIVE);
        floatv depth = (floatv)(INFINITY);
        floatv3 normal = same3((float3)(0.0f)), albedo = normal;
        uintv material_ids = (uintv)(SAHL_AOV_NO_ID);
        if (lane_bits(hit) != 0u) {
            const uintv primitive = borrowed(hit, hit_primitive);
            const realv3 d = load_soa3v_real(rays, SAHL_RAY_DIRECTION, SAHL_RAY_DIRECTION_LOW, capacity, i);
            const realv3 origin = load_soa3v_real(rays, SAHL_RAY_ORIGIN, SAHL_RAY_ORIGIN_LOW, capacity, i);
            const floatv3 place = load_soa3v(hits, SAHL_HIT_T, capacity, i);
            const Surfaces surfaces = surfaces_at(&shapes, hit, instance, primitive, &origin, &d, &place);
            const realv3 facing = where(dotv(surfaces.ns, d) > (real)0, negated(surfaces.ns), surfaces.ns);
            depth = where(hit, convert_floatv(surfaces.t * dotv(d, forward)), depth);
            material_ids = hit ? surfaces.material : material_ids;
            for (uint rest = lane_bits(hit); rest != 0u;) {
                const uint material_id = ((const uint*)&surfaces.material)[lowest_lane(rest)];
                const global DeviceMaterial* material = materials + material_id;
                const intv lanes = hit & (surfaces.material == material_id);
                const bool turned = (material->flags & SAHL_MATERIAL_TWO_SIDED) != 0u;
                rest &= ~lane_bits(lanes);
                normal = where(lanes, roundv(turned ? facing : surfaces.ns), normal);
                albedo = where(
                    lanes, surface_colors(&shapes, material, textures, &surfaces, primitive).diffuse, albedo);
            }
        }
        vstorev(depth, values + (size_t)SAHL_AOV_DEPTH * capacity + i);
        store_soa3v(values, SAHL_AOV_NORMAL, capacity, i, normal);
        store_soa3v(values, SAHL_AOV_ALBEDO, capacity, i, albedo);
        store_idsv(ids, SAHL_AOV_PRIMITIVE, capacity, i, hit ? hit_primitive : (uintv)(SAHL_AOV_NO_ID));
        store_idsv(ids, SAHL_AOV_INSTANCE, capacity, i, hit ? instance : (uintv)(SAHL_AOV_NO_ID));
        store_idsv(ids, SAHL_AOV_MATERIAL, capacity, i, material_ids);
    }
}
