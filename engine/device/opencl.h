// The one include of the OpenCL C++ headers, and how their error codes become errors.
// For engine/device alone: nothing outside this folder sees OpenCL.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>

#include <string>
#include <string_view>

#include "engine/core/error.h"

namespace sahl {

/// "CL_OUT_OF_RESOURCES (-5)"; codes that no header names keep their number.
std::string cl_error_name(cl_int code);

/// Throws Error "<what> failed: <name of the code>" unless `status` is CL_SUCCESS.
void check_cl(cl_int status, std::string_view what, ExitCode code = ExitCode::device);

}  // namespace sahl
