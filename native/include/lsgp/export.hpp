// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#if defined(LSGP_STATIC)
#define LSGP_API
#elif defined(_WIN32)
#if defined(LSGP_BUILDING)
#define LSGP_API __declspec(dllexport)
#else
#define LSGP_API __declspec(dllimport)
#endif
#else
#define LSGP_API __attribute__((visibility("default")))
#endif
