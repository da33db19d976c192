// A plugin of Oclgrind that counts what kernels do: for each launch a line of JSON in the file that the
// environment variable SAHL_COSTS names. Oclgrind's own counts are by instruction, whatever the width of its
// vectors; these are by element. Built by bench/costs.py; the class and its functions' names are Oclgrind's.
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include <llvm/IR/Instructions.h>

#include <oclgrind/Context.h>
#include <oclgrind/Kernel.h>
#include <oclgrind/KernelInvocation.h>
#include <oclgrind/Memory.h>
#include <oclgrind/Plugin.h>

namespace {

class CountCosts : public oclgrind::Plugin {
public:
    explicit CountCosts(const oclgrind::Context* context)
        : Plugin(context), file_(std::getenv("SAHL_COSTS"), std::ios::app) {}

    /// Work-groups are to run one after the other: the sums are everyone's.
    bool isThreadSafe() const override { return false; }

    void kernelBegin(const oclgrind::KernelInvocation*) override { flop_ = loaded_ = stored_ = 0; }

    void kernelEnd(const oclgrind::KernelInvocation* launch) override {
        file_ << "{\"kernel\": \"" << launch->getKernel()->getName() << "\", \"flop\": " << flop_
              << ", \"loaded\": " << loaded_ << ", \"stored\": " << stored_ << "}" << std::endl;
    }

    void instructionExecuted(const oclgrind::WorkItem*, const llvm::Instruction* instruction,
                             const oclgrind::TypedValue& result) override {
        flop_ += std::uint64_t{operations(*instruction)} * result.num;
    }

    void memoryLoad(const oclgrind::Memory* memory, const oclgrind::WorkItem*, size_t, size_t size) override {
        if (memory->getAddressSpace() == oclgrind::AddrSpaceGlobal) loaded_ += size;
    }

    void memoryStore(const oclgrind::Memory* memory, const oclgrind::WorkItem*, size_t, size_t size,
                     const uint8_t*) override {
        if (memory->getAddressSpace() == oclgrind::AddrSpaceGlobal) stored_ += size;
    }

private:
    /// As kernels/count_visits.h counts them, of one element.
    static unsigned operations(const llvm::Instruction& instruction) {
        switch (instruction.getOpcode()) {
            case llvm::Instruction::FAdd:
            case llvm::Instruction::FSub:
            case llvm::Instruction::FMul:
            case llvm::Instruction::FDiv:
                return 1;
            case llvm::Instruction::Call: {
                const auto* callee = static_cast<const llvm::CallInst&>(instruction).getCalledFunction();
                if (callee == nullptr) return 0;
                const std::string_view name(callee->getName().data(), callee->getName().size());
                const bool fused = name.starts_with("_Z3fma") || name.starts_with("_Z3mad") ||
                                   name.starts_with("llvm.fma") || name.starts_with("llvm.fmuladd");
                return fused ? 2 : 0;
            }
            default:
                return 0;
        }
    }

    std::ofstream file_;
    std::uint64_t flop_ = 0, loaded_ = 0, stored_ = 0;
};

CountCosts* plugin = nullptr;

}  // namespace

extern "C" void initializePlugins(oclgrind::Context* context) {
    plugin = new CountCosts(context);
    context->registerPlugin(plugin);
}

extern "C" void releasePlugins(oclgrind::Context* context) {
    context->unregisterPlugin(plugin);
    delete plugin;
    plugin = nullptr;
}
