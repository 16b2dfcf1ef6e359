// SPDX-License-Identifier: MIT
#include "datasets/scene.h"
