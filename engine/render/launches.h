// The kernels of a wave with their arguments: one function a kernel.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/device/program.h"
#include "engine/render/device_scene.h"
#include "engine/render/ray_queues.h"
#include "engine/render/visit_counter.h"
#include "kernels/device_types.h"

namespace sahl {

class IncoherentIntersect;

/// The files of kernels/ that WavefrontKernels are in.
std::vector<std::string> wavefront_sources(Traversal traversal);

/// Of which WavefrontKernels are made, with the device's way of traversal.
Program build_wavefront_program(Device& device, Compilation compilation = Compilation::optimized);

/// The same with kernels that count visits (engine/render/visits.h) and have to be launched with a
/// VisitCounter.
Program build_counting_program(Device& device, Traversal traversal,
                               Compilation compilation = Compilation::optimized);

/// The file of kernels/ that the kernel for incoherent batches is in, and a program of it, which counts or
/// not.
std::vector<std::string> incoherent_sources(Traversal traversal);
Program build_incoherent_program(Device& device, bool counting);

/// A kernel that walks through the tree.
struct TracingKernel {
    Traversal way;
    Kernel kernel;
};
/// "intersect" or "shadow" of `program`, which has it that way.
TracingKernel tracing_kernel(const char* name, Traversal way, Program& program);

/// The kernels of kernels/*.cl. What no launch asks for is never compiled.
struct WavefrontKernels {
    WavefrontKernels(Traversal traversal, Program& program);
    /// With a kernel of another program.
    WavefrontKernels(Traversal traversal, Program& program, TracingKernel intersecting);

    Kernel generate, shade;
    TracingKernel intersect, shadow;
    Kernel count_children, sum_children, compact;
};

/// What the launches work with; all of it outlives them.
struct Wavefront {
    Device& device;
    WavefrontKernels& kernels;
    const DeviceScene& scene;
    RayQueues& queues;
    VisitCounter* visits = nullptr;             ///< of counting kernels
    IncoherentIntersect* incoherent = nullptr;  ///< nothing: all batches have the same kernel
};

/// A batch that waits to be traced or is in work.
struct WaitingBatch {
    std::uint32_t slot;  ///< in RayQueues::batches
    std::uint32_t count;
    std::uint32_t generation;
    bool coherent = true;  ///< whether neighbours keep together
};

/// Rays of a work-item of kernels that take them in groups of SAHL_LANES (kernels/lanes.h).
std::uint32_t rays_in_groups(const Device& device);

/// Camera rays of a wave.
void launch_generate(Wavefront& wavefront, const device::CameraConstants& camera,
                     const device::WaveConstants& wave, RayBatch& out);

/// The batch's hits.
void launch_intersect(Wavefront& wavefront, const WaitingBatch& in_work);

/// Light without shadow test into `out`, shadow surfaces and light; where `spawn`, children.
void launch_shade(Wavefront& wavefront, const WaitingBatch& in_work, bool spawn, Contributions& out);

/// Adds the light that arrives to `out`.
void launch_shadow(Wavefront& wavefront, const WaitingBatch& in_work, Contributions& out);

/// The children and shadow rays of each block of parents.
void launch_count_children(Wavefront& wavefront, const WaitingBatch& in_work);

/// The places of each block's children, and the totals of `out` but for their ways.
void launch_sum_children(Wavefront& wavefront, const WaitingBatch& in_work, Contributions& out);

/// The children into `next`, which may be the batch in work (children are staged), and what it cannot
/// hold into `waiting`; their ways into the totals of `out`.
void launch_compact(Wavefront& wavefront, const WaitingBatch& in_work, RayBatch& next, RayBatch& waiting,
                    Contributions& out);

/// The parts that parents are compacted by.
constexpr std::uint32_t compact_blocks(std::uint32_t count) {
    return (count + SAHL_COMPACT_BLOCK - 1) / SAHL_COMPACT_BLOCK;
}

}  // namespace sahl
