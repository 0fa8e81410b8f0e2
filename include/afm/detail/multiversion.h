#pragma once
#define AFM_MULTIVERSION
#define AFM_INLINED inline
