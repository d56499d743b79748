// What the shaders that build queues read and write. Included after queue_types.h.
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_VERDICTS, std430) readonly buffer Verdicts { uint verdicts[]; };
// Per group of people, the queues side by side: how many the group has; once scanned, those of the groups before.
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_COUNTS, std430) buffer Counts { uint counts[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_TOTALS, std430) coherent buffer Totals { GpuQueueTotal totals[]; };

layout(push_constant) uniform Push { GpuQueuePush push; };
