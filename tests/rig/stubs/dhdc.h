/* What examples/bridges/force_dimension.c takes of Force Dimension's SDK 3, to compile it without. */
#pragma once

int dhdOpen(void);
int dhdEnableForce(unsigned char on, char device);
int dhdGetPosition(double* x, double* y, double* z, char device);
int dhdSetForce(double x, double y, double z, char device);
int dhdClose(char device);
const char* dhdErrorGetLastStr(void);
