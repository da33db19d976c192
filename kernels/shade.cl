// Hits -> light that needs no shadow test (ambient, emission, background), the light that each
// shadow ray would bring, and reflected and transmitted rays with their weights.
//
// SAHL_LANES neighbours at a time. Their surfaces are found together; then each material among them is dealt
// with once, for the lanes that have it: mostly all of them.

#include "kernels/light.h"
#include "kernels/material.h"
#include "kernels/ray_batch.h"
#include "kernels/shade_flop.h"
#include "kernels/surface.h"
#include "kernels/texture.h"

/// What the kernel works on.
typedef struct {
    Shapes shapes;
    const global DeviceMaterial* materials;
    const global DeviceTexture* textures;
    const global DeviceLight* lights;
    const SceneConstants* scene;
    const global float* rays;
    const global uint* ray_ids;
    const global float* hits;
    const global uint* hit_ids;
    global float* contributions;
    global uint* contribution_pixels;
    global float* shadow_surfaces;
    global float* shadow_light;  // three arrays a lamp
    global float* children;
    global uint* child_ids;
    global uint* outcomes;
    uint capacity, count, spawn;
} ShadeWork;

/// The light of all lamps on `lanes`, each as if nothing were in between, into the shadow light from i on.
/// Returns how many bring any: their shadow rays are to be traced.
static inline intv shade_lights(const ShadeWork* work, uint i, const global DeviceMaterial* material,
                                const SurfaceColors* colors, floatv3 position, floatv3 ns, floatv3 wo,
                                floatv3 weight, StoredLanes lanes) {
    intv shadow_rays = (intv)(0);
    for (uint l = 0; l < work->scene->light_count; ++l) {
        const global DeviceLight* light = work->lights + l;
        SAHL_COUNT_LANES(&work->shapes,
                         light_flop(light, material, lane_bits(nonzerov(colors->specular)) != 0u));
        floatv3 to_light = vectors_to_light(light, position);
        floatv distance = sqrt(dotv(to_light, to_light));
        floatv3 wi = div(to_light, distance);
        floatv3 brought = mul(phong_light(material, colors->diffuse, colors->specular, ns, wi, wo),
                              arriving_light(light, wi, distance));
        brought = mul(brought, weight);
        shadow_rays -= nonzerov(brought);
        store_soa3_lanes(lanes, work->shadow_light, 3u * l, work->capacity, i, brought);
    }
    return shadow_rays;
}

/// What hits send on: `reflected` with weights kr, `transmitted` with weights kt; a weight of 0
/// stands for no ray.
typedef struct {
    realv3 reflected, transmitted;
    floatv3 kr, kt;
} Scattering;

static inline Scattering scatter(const global DeviceMaterial* material, floatv3 reflection,
                                 const Surfaces* surfaces, realv3 ns, realv3 facing, realv3 d) {
    Scattering s;
    s.transmitted = d;
    s.reflected = d;
    s.kr = reflection;
    s.kt = same3(load3(material->transmission));
    if (material->flags & SAHL_MATERIAL_TRANSMITS) {
        const real ior = material->ior, outside = material->ior_outside;
        realv eta = where(dotv(surfaces->ng, d) < (real)0, (realv)(outside / ior), (realv)(ior / outside));
        // Total internal reflection sends the transmitted light the mirror's way.
        intv passes = convert_intv(refracted_directions(d, facing, eta, &s.transmitted));
        s.kr = where(passes, s.kr, add(s.kr, s.kt));
        s.kt = where(passes, s.kt, same3((float3)(0.0f)));
    }
    if (lane_bits(nonzerov(s.kr)) != 0u) {
        s.reflected = reflected_directions(d, ns);
    }
    return s;
}

/// The weights of rays' light, which `distance` may have attenuated on its way to where they start.
static inline floatv3 attenuated_weights(const ShadeWork* work, floatv3 weight, uintv start,
                                         floatv distance) {
    const intv attenuated = (start & SAHL_RAY_ATTENUATED) != 0u;
    for (uint rest = lane_bits(attenuated); rest != 0u; rest &= rest - 1u) {
        SAHL_COUNT_LANES(&work->shapes, SAHL_FALLOFF_FLOP);
        const uint lane = lowest_lane(rest);
        const uint on = ((const uint*)&start)[lane] & SAHL_ID_MASK;
        const floatv falloff =
            reflection_falloff(work->materials + work->shapes.primitives[on].material, distance);
        weight = where(lane_numbers() == (intv)((int)lane), mul(weight, falloff), weight);
    }
    return weight;
}

/// Shades the hits of rays i to i + SAHL_LANES - 1.
SAHL_NOINLINE void shade_group(const ShadeWork* work, uint i) {
    const uint capacity = work->capacity;
    const uintv pixel = load_idsv(work->ray_ids, SAHL_RAY_PIXEL, capacity, i);
    const uintv hit_primitive = load_idsv(work->hit_ids, SAHL_HIT_PRIMITIVE, capacity, i);
    const uintv instance = load_idsv(work->hit_ids, SAHL_HIT_INSTANCE, capacity, i);
    const uintv start = load_idsv(work->ray_ids, SAHL_RAY_EXCLUDE, capacity, i);
    const floatv3 place = load_soa3v(work->hits, SAHL_HIT_T, capacity, i);
    const intv there = lane_numbers() < (intv)((int)(work->count - i));
    const intv hit = there & (hit_primitive != SAHL_NO_PRIMITIVE);
    const floatv3 weight = attenuated_weights(work, load_soa3v(work->rays, SAHL_RAY_WEIGHT, capacity, i),
                                              there ? start : (uintv)(0u), place.x);
    const floatv3 background = mul(
        weight,
        same3((float3)(work->scene->background[0], work->scene->background[1], work->scene->background[2])));
    vstorev(pixel, work->contribution_pixels + i);
    SAHL_COUNT_LANES(&work->shapes, SAHL_BACKGROUND_FLOP);
    if (lane_bits(hit) == 0u) {
        store_soa3v(work->contributions, 0u, capacity, i, background);
        vstorev((uintv)(0u), work->outcomes + i);
        return;
    }
    SAHL_COUNT_LANES(&work->shapes, SAHL_HIT_FLOP);
    const uintv primitive = borrowed(hit, hit_primitive);
    const realv3 d = load_soa3v_real(work->rays, SAHL_RAY_DIRECTION, SAHL_RAY_DIRECTION_LOW, capacity, i);
    const realv3 origin = load_soa3v_real(work->rays, SAHL_RAY_ORIGIN, SAHL_RAY_ORIGIN_LOW, capacity, i);
    const Surfaces surfaces = surfaces_at(&work->shapes, hit, instance, primitive, &origin, &d, &place);
    const realv3 facing = where(dotv(surfaces.ns, d) > (real)0, negated(surfaces.ns), surfaces.ns);
    const floatv3 position = roundv(surfaces.position);
    const floatv3 offset = mul(roundv(surfaces.ng), surfaces.offset);

    store_soa3v(work->shadow_surfaces, SAHL_SURFACE_POSITION, capacity, i, position);
    store_soa3v(work->shadow_surfaces, SAHL_SURFACE_OFFSET, capacity, i, offset);

    floatv3 emitted = background;
    uintv outcomes = (uintv)(0u);
    for (uint rest = lane_bits(hit); rest != 0u;) {
        const uint material_id = ((const uint*)&surfaces.material)[lowest_lane(rest)];
        const global DeviceMaterial* material = work->materials + material_id;
        const StoredLanes lanes = {hit & (surfaces.material == material_id), rest == lane_bits(hit)};
        rest &= ~lane_bits(lanes.mask);
        SAHL_COUNT_LANES(&work->shapes, SAHL_EMISSION_FLOP);
        const realv3 ns = material->flags & SAHL_MATERIAL_TWO_SIDED ? facing : surfaces.ns;
        const SurfaceColors colors =
            surface_colors(&work->shapes, material, work->textures, &surfaces, primitive);
        emitted = where(lanes.mask, mul(weight, colors.emitted), emitted);
        const intv shadow_rays =
            shade_lights(work, i, material, &colors, position, roundv(ns), roundv(negated(d)), weight, lanes);
        uintv outcome = as_uintv(shadow_rays) * SAHL_OUTCOME_SHADOW_RAY;
        if (work->spawn) {
            const Scattering s = scatter(material, colors.reflection, &surfaces, ns, facing, d);
            const intv reflects = nonzerov(s.kr), transmits = nonzerov(s.kt);
            SAHL_COUNT_LANES(&work->shapes, scattering_flop(material, lane_bits(reflects) != 0u));
            outcome |= (as_uintv(reflects) & SAHL_OUTCOME_REFLECTED) |
                       (as_uintv(transmits) & SAHL_OUTCOME_TRANSMITTED);
            if (lane_bits(reflects & lanes.mask) != 0u) {
                SAHL_COUNT_LANES(&work->shapes, SAHL_CHILD_FLOP);
                const uint attenuated = material->flags & SAHL_MATERIAL_ATTENUATES ? SAHL_RAY_ATTENUATED : 0u;
                store_rays(lanes, work->children, work->child_ids, capacity, i,
                           offset_origins(position, offset, roundv(s.reflected)), surfaces.position,
                           s.reflected, primitive | attenuated, instance, mul(weight, s.kr), pixel);
            }
            if (lane_bits(transmits & lanes.mask) != 0u) {
                SAHL_COUNT_LANES(&work->shapes, SAHL_CHILD_FLOP);
                store_rays(lanes, work->children + (size_t)SAHL_RAY_FLOATS * capacity,
                           work->child_ids + (size_t)SAHL_RAY_UINTS * capacity, capacity, i,
                           offset_origins(position, offset, roundv(s.transmitted)), surfaces.position,
                           s.transmitted, primitive, instance, mul(weight, s.kt), pixel);
            }
        }
        outcomes = lanes.mask ? outcome : outcomes;
    }
    store_soa3v(work->contributions, 0u, capacity, i, emitted);
    vstorev(outcomes, work->outcomes + i);
}

kernel void shade(const global DevicePrimitive* primitives, const global float* shape_data,
                  const global DeviceInstance* instances, const global DeviceMaterial* materials,
                  const global DeviceTexture* textures, const global DeviceLight* lights,
                  const SceneConstants scene, const global float* rays, const global uint* ray_ids,
                  const global float* hits, const global uint* hit_ids, global float* contributions,
                  global uint* contribution_pixels, global float* shadow_surfaces, global float* shadow_light,
                  global float* children, global uint* child_ids, global uint* outcomes, const uint capacity,
                  const uint count, const uint spawn SAHL_COUNTS_PARAMETER) {
    const ShadeWork work = {{primitives, shape_data, instances SAHL_COUNTS_AT(get_global_id(0))},
                            materials,
                            textures,
                            lights,
                            &scene,
                            rays,
                            ray_ids,
                            hits,
                            hit_ids,
                            contributions,
                            contribution_pixels,
                            shadow_surfaces,
                            shadow_light,
                            children,
                            child_ids,
                            outcomes,
                            capacity,
                            count,
                            spawn};
    SAHL_FOR_EACH_GROUP(i, count) { shade_group(&work, i); }
}
