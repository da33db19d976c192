// How many rays a work-item takes of a kernel that traces them together; the host launches as many items as
// that makes, as idle ones among them would leave threads without work.
#ifndef SAHL_RAYS_PER_ITEM_H
#define SAHL_RAYS_PER_ITEM_H

#define SAHL_LANES 8u  // rays shaded side by side
#define SAHL_PACKET_RAYS 128u
#define SAHL_STREAM_RAYS 1024u
#define SAHL_SHADOW_RAYS 256u  // hits whose shadow rays are gathered

#endif
