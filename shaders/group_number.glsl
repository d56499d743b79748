// Groups of a dispatch that may be more than a device's limit along one axis: in rows of one length, so that hardly
// any are there for nothing. The last row may be longer than needed.

// Included after crowd_types.h.
uint groupNumber() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

// Along x and y.
uvec2 groupRows(uint count) {
  uint rows = (count + ENSEMBLE_MOST_GROUPS_X - 1u) / ENSEMBLE_MOST_GROUPS_X;
  return uvec2(rows == 0u ? 0u : (count + rows - 1u) / rows, rows);
}
