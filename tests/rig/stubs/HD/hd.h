/* What examples/bridges/openhaptics.c takes of OpenHaptics 3's HDAPI, to compile it without. */
#pragma once

#define HDAPIENTRY
#define HDCALLBACK
#define HD_DEFAULT_DEVICE 0
#define HD_INVALID_HANDLE 0xFFFFFFFF
#define HD_CURRENT_POSITION 0x2050
#define HD_CURRENT_FORCE 0x2700
#define HD_FORCE_OUTPUT 0x4000
#define HD_DEFAULT_SCHEDULER_PRIORITY 0x7fff
#define HD_CALLBACK_CONTINUE 1

typedef unsigned int HHD;
typedef unsigned int HDenum;
typedef unsigned int HDCallbackCode;
typedef unsigned long HDSchedulerHandle;
typedef double HDdouble;
typedef unsigned short HDushort;
typedef HDCallbackCode(HDCALLBACK* HDSchedulerCallback)(void* data);

HHD HDAPIENTRY hdInitDevice(const char* name);
HHD HDAPIENTRY hdGetCurrentDevice(void);
void HDAPIENTRY hdEnable(HDenum capability);
void HDAPIENTRY hdBeginFrame(HHD device);
void HDAPIENTRY hdEndFrame(HHD device);
void HDAPIENTRY hdGetDoublev(HDenum name, HDdouble* values);
void HDAPIENTRY hdSetDoublev(HDenum name, const HDdouble* values);
void HDAPIENTRY hdStartScheduler(void);
HDSchedulerHandle HDAPIENTRY hdScheduleAsynchronous(HDSchedulerCallback callback, void* data, HDushort priority);
