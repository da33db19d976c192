// The structs that the host fills and the kernels read: with rays_per_item.h all that C++ and OpenCL
// C share. 32-bit scalars only; sizes are asserted on both sides and offsets checked by a test.
#ifndef SAHL_DEVICE_TYPES_H
#define SAHL_DEVICE_TYPES_H

#ifndef __cplusplus
#define SAHL_STATIC_ASSERT(condition, text) _Static_assert(condition, text)
typedef uint sahl_uint;
#else
#include <cstdint>
#define SAHL_STATIC_ASSERT(condition, text) static_assert(condition, text)
namespace sahl::device {
using sahl_uint = std::uint32_t;
#endif

// ---- Acceleration structure -------------------------------------------------------------

// Kinds of leaves. A sphere whose transform is no similarity is an ellipsoid; a cylinder is a cone of
// slope 0.
#define SAHL_KIND_TRIANGLE 0u
#define SAHL_KIND_SPHERE 1u
#define SAHL_KIND_ELLIPSOID 2u
#define SAHL_KIND_CONE 3u
#define SAHL_KIND_POLYGON 4u
#define SAHL_KIND_SOLID_CONE 5u
#define SAHL_KIND_DISC 6u
#define SAHL_KIND_BOX 7u
#define SAHL_KIND_INSTANCE 8u

// A child reference is a node's index, or a leaf: SAHL_CHILD_LEAF | kind << SAHL_CHILD_KIND_SHIFT
// | offset of its one block in the leaf buffer, in lines of 64 bytes; for an instance: its place in
// the array of instances.
#define SAHL_CHILD_LEAF 0x80000000u
#define SAHL_CHILD_KIND_SHIFT 27u
#define SAHL_CHILD_KIND_MASK 15u
#define SAHL_CHILD_OFFSET_MASK 0x07ffffffu
#define SAHL_LEAF_LINE_BYTES 64u
#define SAHL_BLOCK_WIDTH 4u

// Deepest path in binary splits; an 8-wide path is never longer. A traversal stack holds at most
// 7 waiting siblings a level, the root and one node's overhang.
#define SAHL_MAX_TREE_DEPTH 42u
#define SAHL_STACK_SIZE 304u

// An instance's tree is walked on top of the world's.
#define SAHL_LEVELS 2u

// An id in a block: the primitive's index in Scene::primitives with flags. SAHL_ID_BIAS keeps the
// word, read as a float beside the vertices, from being a denormal.
#define SAHL_ID_BIAS 0x40000000u
#define SAHL_ID_TRANSPARENT 0x08000000u
#define SAHL_ID_BACK_ONLY 0x10000000u
#define SAHL_ID_FRONT_ONLY 0x20000000u
#define SAHL_ID_MASK 0x07ffffffu
#define SAHL_NO_PRIMITIVE 0x07ffffffu
#define SAHL_MAX_PRIMITIVES 0x07fffff0u

// Eight children as structure of arrays, read as float8. Children sit in slots so that visiting
// `slot ^ octant` (bit k of octant: direction component k negative) is front to back. An empty
// slot has lo = +INFINITY, hi = -INFINITY.
typedef struct {
    float lo_x[8], lo_y[8], lo_z[8];
    float hi_x[8], hi_y[8], hi_z[8];
    sahl_uint child[8];
    sahl_uint spare[8];
} BvhNode;
SAHL_STATIC_ASSERT(sizeof(BvhNode) == 256, "BvhNode is four cache lines");

// Up to four triangles; an axis is one line: vertex 0 of the four, vertex 1, vertex 2, and four more numbers,
// which are no denormals. Unused lanes, behind the others, have NaN vertices.
// depth_error[k]: how far the depths by which triangle.h finds what lies behind a ray's origin can be off for
// rays whose shear axis is k.
typedef struct {
    float x[12];
    sahl_uint id[4];
    float y[12];
    float count;  // of triangles
    float depth_error[3];
    float z[12];
    float spare_z[4];
} TriangleBlock;
SAHL_STATIC_ASSERT(sizeof(TriangleBlock) == 192, "TriangleBlock is three lines");

// Four spheres. Unused lanes have a NaN radius.
typedef struct {
    float x[4], y[4], z[4];
    float radius[4];
    sahl_uint id[4];
    sahl_uint spare[12];
} SphereBlock;
SAHL_STATIC_ASSERT(sizeof(SphereBlock) == 128, "SphereBlock is two lines");

// Four shapes in their object spaces, p = m (world - origin): the unit sphere for ellipsoids; for
// cones the surface x² + y² = (1 + slope z)², 0 <= z <= 1, for solid cones what it encloses; the disc
// x² + y² <= 1, z = 0; the box -1 <= x, y, z <= 1. m is row-major. Unused lanes have NaN in m.
typedef struct {
    float m[9][4];
    float x[4], y[4], z[4];
    float slope[4];
    sahl_uint id[4];
    sahl_uint spare[8];
} QuadricBlock;
SAHL_STATIC_ASSERT(sizeof(QuadricBlock) == 256, "QuadricBlock is four lines");

// One polygon: unit normal and a point of the plane, box, and where its outline begins in the scene's
// outlines (counted in groups).
typedef struct {
    float normal[3], point[3];
    float lo[3], hi[3];
    sahl_uint first_group;
    sahl_uint corner_count;
    sahl_uint id;
    sahl_uint spare;
} PolygonBlock;
SAHL_STATIC_ASSERT(sizeof(PolygonBlock) == 64, "PolygonBlock is one line");

// Seven edges of an outline: eight corners, of which the last is the next group's first. Behind the last
// corner comes the first one again, to the group's end.
#define SAHL_OUTLINE_EDGES 7u
typedef struct {
    float x[8], y[8], z[8];
} OutlineGroup;
SAHL_STATIC_ASSERT(sizeof(OutlineGroup) == 96, "OutlineGroup is 24 floats");

// A group in the world. Rows of object_from_world: x, y, z and the translation, then what these four
// floats lack of the double precision values.
typedef struct {
    float rows[3][8];
    sahl_uint root;  // node of the group's tree
    float extent;    // largest |coordinate| of the group's bounds
    sahl_uint spare[6];
} DeviceInstance;
SAHL_STATIC_ASSERT(sizeof(DeviceInstance) == 128, "DeviceInstance is two lines");

// Instance 0 is the world; DeviceInstance i is instance i + 1.
#define SAHL_WORLD 0u

// ---- Shading ----------------------------------------------------------------------------

// What shading looks up by primitive id. `data` is an offset (in floats) into the shape data:
//   triangle   vertices 0..2; if smooth also normals 0..2; if it has them uv 0..2
//   sphere     centre, radius
//   ellipsoid, disc, box   rows 0..2 of m, origin
//   cone, solid cone       rows 0..2 of m, origin, slope
//   polygon    unit normal, a point, then (bits of uints) the outline's first group, corner count, then what
//              u and v are the products of with the vector from the point
// For all but triangles and uv each vector is three floats and the three that they lack of the
// double precision value, each number a float and the one it lacks.
#define SAHL_PRIMITIVE_SMOOTH 1u
#define SAHL_PRIMITIVE_UV 2u      // a triangle that has uv
#define SAHL_PRIMITIVE_TURNED 4u  // a cone whose apex is at z = 0
typedef struct {
    sahl_uint kind;
    sahl_uint material;
    sahl_uint data;
    sahl_uint flags;
} DevicePrimitive;
SAHL_STATIC_ASSERT(sizeof(DevicePrimitive) == 16, "DevicePrimitive is 16 bytes");  // see load_primitives()

#define SAHL_MATERIAL_TWO_SIDED 1u
#define SAHL_MATERIAL_BLINN 2u
#define SAHL_MATERIAL_TRANSMITS 4u
#define SAHL_MATERIAL_TEXTURED 8u
#define SAHL_MATERIAL_ATTENUATES 16u  // reflected light, by distance
#define SAHL_NO_TEXTURE 0xffffffffu
typedef struct {
    float ambient[3];  // times the ambient light
    float shininess;
    float diffuse[3];
    float ior;
    float specular[3];
    sahl_uint flags;
    float reflection[3];
    float ior_outside;
    float transmission[3];
    sahl_uint ambient_texture;
    float emission[3];
    sahl_uint diffuse_texture;
    float attenuation[3];
    sahl_uint specular_texture;
    sahl_uint emission_texture, reflection_texture;
    sahl_uint spare[2];
} DeviceMaterial;
SAHL_STATIC_ASSERT(sizeof(DeviceMaterial) == 128, "DeviceMaterial is 128 bytes");

// Vectors as three floats and the three that they lack of the double precision value.
#define SAHL_PATTERN_CHECKER 0u
#define SAHL_PATTERN_GRADIENT 1u
#define SAHL_TEXTURE_POSITION 0u
#define SAHL_TEXTURE_UV 1u
typedef struct {
    float color0[3];
    sahl_uint pattern;
    float color1[3];
    sahl_uint space;
    float origin[6];
    float extent[6];
} DeviceTexture;
SAHL_STATIC_ASSERT(sizeof(DeviceTexture) == 80, "DeviceTexture is 80 bytes");

#define SAHL_LIGHT_POINT 0u
#define SAHL_LIGHT_DIRECTIONAL 1u
#define SAHL_LIGHT_SPOT 2u
typedef struct {
    float position[3];  // or the unit vector towards a directional light
    sahl_uint kind;
    float color[3];
    float cos_inner;  // of a spot's angles
    float attenuation[3];
    float cos_outer;
    float direction[3];  // the way a spot shines, unit
    float spare;
} DeviceLight;
SAHL_STATIC_ASSERT(sizeof(DeviceLight) == 64, "DeviceLight is 64 bytes");

typedef struct {
    float background[3];
    float extent;  // largest |coordinate| of the scene's bounds
    sahl_uint light_count;
    sahl_uint spare[3];
} SceneConstants;
SAHL_STATIC_ASSERT(sizeof(SceneConstants) == 32, "SceneConstants is 32 bytes");

// ---- Waves ------------------------------------------------------------------------------

// A camera ray through image position (x, y), pixels, y down:
// eye, normalize(forward + step_x (x - width/2) + step_y (y - height/2)); each vector in two parts,
// floats and what they lack of the double precision value.
typedef struct {
    float eye[3];
    float half_width;  // in pixels
    float forward[3];
    float half_height;
    float step_x[3], step_y[3];
    float eye_low[3], forward_low[3], step_x_low[3], step_y_low[3];
    float spare[2];
} CameraConstants;
SAHL_STATIC_ASSERT(sizeof(CameraConstants) == 112, "CameraConstants is 112 bytes");

// Which camera samples a wave generates: `count` of them from number `first` (low and high word)
// on, counted pixel by pixel in the crop's tile order: `samples` of each pixel's `spp`, from sample
// `first_sample` on.
typedef struct {
    sahl_uint first_low, first_high;
    sahl_uint count;
    sahl_uint spp;
    sahl_uint crop_x, crop_y, crop_width, crop_height;
    sahl_uint seed_low, seed_high;
    sahl_uint first_sample;
    sahl_uint samples;
} WaveConstants;
SAHL_STATIC_ASSERT(sizeof(WaveConstants) == 48, "WaveConstants is 48 bytes");

// Arrays of a ray batch, each `capacity` long, one after the other: SAHL_RAY_FLOATS float arrays
// in one buffer, SAHL_RAY_UINTS uint arrays in another.
// Traversal reads origin and direction, in single precision and off the surface; shading adds
// what they lack of the exact ray.
#define SAHL_RAY_ORIGIN 0
#define SAHL_RAY_DIRECTION 3
#define SAHL_RAY_WEIGHT 6
#define SAHL_RAY_ORIGIN_LOW 9
#define SAHL_RAY_DIRECTION_LOW 12
#define SAHL_RAY_FLOATS 15
#define SAHL_RAY_PIXEL 0     // index in the film
#define SAHL_RAY_EXCLUDE 1   // the primitive it starts on, or SAHL_NO_PRIMITIVE, with SAHL_RAY_ATTENUATED
#define SAHL_RAY_INSTANCE 2  // the instance of that primitive
#define SAHL_RAY_UINTS 3

// The ray's light is attenuated by its length, as the material that it starts on says.
#define SAHL_RAY_ATTENUATED 0x80000000u

// Hits: t, u, v in one buffer; the primitive or SAHL_NO_PRIMITIVE, and its instance, in another.
#define SAHL_HIT_T 0
#define SAHL_HIT_U 1
#define SAHL_HIT_V 2
#define SAHL_HIT_FLOATS 3
#define SAHL_HIT_PRIMITIVE 0
#define SAHL_HIT_INSTANCE 1
#define SAHL_HIT_UINTS 2

// What shadow rays start from: the position and the vector ng·offset off the surface.
#define SAHL_SURFACE_POSITION 0
#define SAHL_SURFACE_OFFSET 3
#define SAHL_SURFACE_FLOATS 6

// What became of a ray: which children it has, and how many shadow rays above these bits.
#define SAHL_OUTCOME_REFLECTED 1u
#define SAHL_OUTCOME_TRANSMITTED 2u
#define SAHL_OUTCOME_SHADOW_RAY 4u

// AOVs: arrays of floats and of ids.
#define SAHL_AOV_DEPTH 0
#define SAHL_AOV_NORMAL 1
#define SAHL_AOV_ALBEDO 4
#define SAHL_AOV_FLOATS 7
#define SAHL_AOV_PRIMITIVE 0
#define SAHL_AOV_INSTANCE 1
#define SAHL_AOV_MATERIAL 2
#define SAHL_AOV_UINTS 3
#define SAHL_AOV_NO_ID 0xffffffffu

// What kernels that count (SAHL_COUNT_VISITS) add up, ulongs for each work-item.
#define SAHL_COUNT_NODES 0       // nodes opened: by packets once for all their rays
#define SAHL_COUNT_LEAVES 1      // leaf blocks loaded, the same
#define SAHL_COUNT_LEAF_BYTES 2  // of these blocks
#define SAHL_COUNT_FLOP 3        // floating-point operations of tests that every ray of a node or block has
#define SAHL_COUNT_LIT 4         // shadow rays that reach their light
#define SAHL_COUNTS 5

// Parents that one work-item compacts.
#define SAHL_COMPACT_BLOCK 256u

// What a batch leaves to be known of it, in words.
#define SAHL_TOTAL_CHILDREN 0u
#define SAHL_TOTAL_SHADOW_RAYS 1u  // low and high word
#define SAHL_TOTAL_FAMILIES 3u  // reflected or transmitted children of a block of parents, where it has any
#define SAHL_TOTAL_WAYS 4u      // octants and axes that each family's rays go along, summed over all
#define SAHL_TOTALS 5u

#ifdef __cplusplus
}  // namespace sahl::device
#endif

#endif
