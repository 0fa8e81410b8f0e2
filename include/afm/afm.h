// The library in one include, in the order in which the paper is read. Natural units: lattice spacing a, time
// tau = 2 pi / omega_v, tip mass m.
#pragma once

#include "afm/number_text.h"
#include "afm/model.h"
#include "afm/units.h"
#include "afm/state.h"
#include "afm/surface.h"
#include "afm/flight.h"
#include "afm/impact_search.h"
#include "afm/reflection.h"
#include "afm/single_flight.h"
#include "afm/contact.h"
#include "afm/chatter.h"
#include "afm/segment.h"
#include "afm/bath.h"
#include "afm/tip.h"
#include "afm/friction.h"
#include "afm/ensemble.h"
#include "afm/level.h"
#include "afm/level_table.h"
#include "afm/run.h"
#include "afm/pacer.h"
