/// @file voxels.h
/// Networks as voxels: the masks, labels and soft volumes that segmentation is trained and checked on.
#ifndef VENULE_VOXELS_H
#define VENULE_VOXELS_H

#include "venule/domain.h"
#include "venule/network.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What a voxel says of the network. A voxel belongs to a vessel when its centre lies in the tube of an edge
/// (a cylinder with round ends) or when the edge's digital line passes it, so that vessels thinner than a
/// voxel do not break: what hangs together in the network hangs together in the volume, by faces, edges or
/// corners of voxels. Where tubes overlap, the one that the centre lies deepest in has it (of equal ones the
/// first), for all contents alike: volumes of one network fit each other voxel by voxel.
typedef enum vn_voxels_content {
    VN_VOXELS_MASK,  ///< u8: 1 in vessels
    VN_VOXELS_LABEL, ///< u16: which network, from 1: what classes such as arteries and veins are trained on
    VN_VOXELS_TREE,  ///< u16: which tree, from 1, numbered on through the networks: instances of vessels
    VN_VOXELS_ORDER, ///< u16: vein order: the network's orders, or Strahler's where none are known
    /// u32: which branch: its edges between branchings, tips and joins have the number of the node at their
    /// far end, from 1, by which the network's columns and files tell more of it. Joins are numbered on after
    /// the nodes, and further networks after the ones before.
    VN_VOXELS_SEGMENT,
    VN_VOXELS_RADIUS,     ///< f32: the radius of the vessel, in the network's unit
    VN_VOXELS_CENTERLINE, ///< u8: 1 on the digital lines alone
    /// f32: which part of the voxel vessels fill, 0 to 1, as a scanner would see it. It is the overlap of the
    /// tube's section with a disc (in 2D: an interval) of a voxel's size, so that voxels sum up to the volume
    /// of thin and thick vessels alike. Above 0 on all digital lines.
    VN_VOXELS_VESSELNESS,
} vn_voxels_content;

typedef struct vn_voxels_def {
    const vn_network *network;         ///< what becomes voxels; or
    const vn_network *const *networks; ///< several, all of one dimension and one unit
    int32_t network_count;             ///< of `networks`
    int content;                       ///< vn_voxels_content; default VN_VOXELS_MASK
    double resolution;                 ///< side of a voxel, length, > 0; default 0: from `size`
    int32_t size;   ///< voxels along the longest side, margins included, 1 to 2^20; default 0: 128, or from
                    ///< `resolution`
    int32_t margin; ///< voxels kept free around the bounds, 0 to 65,536; default -1: 1 around the vessels,
                    ///< none around bounds that are given
    vn_box bounds;  ///< what the volume covers: vessels are cut there; default all 0: all vessels, with
                    ///< their radii
} vn_voxels_def;
VN_API vn_voxels_def vn_voxels_def_default(void);

/// Voxels in space; a 2D network's are flat: one voxel in z.
typedef struct vn_volume vn_volume;

/// Make voxels of networks, in time proportional to the voxels that are touched and the size of the volume.
/// VN_INVALID for networks without radii (but for VN_VOXELS_CENTERLINE), or whose dimensions or units differ;
/// VN_LIMIT beyond 2^31 - 1 voxels, 2^20 along a side, or numbers that the content's type does not hold.
VN_API vn_status vn_voxelize(vn_volume **out, const vn_voxels_def *def);
VN_API void vn_volume_destroy(vn_volume *volume);

/// Write a volume by the extension of @p path: NIfTI-1 (".nii", ".nii.gz"), NRRD (".nrrd", packed), DGtal's
/// ".vol" (bytes; a mask's 1 becomes 255), and of a flat one a ".pgm" (8 or 16 bits, y up). @p manifest
/// (JSON, may be NULL) goes inside where there is room for it: not into .vol. VN_INVALID for another
/// extension, or for voxels that the format does not hold; VN_IO when it cannot be written; then no file is
/// left behind.
VN_API vn_status vn_volume_write(const vn_volume *volume, const char *path, const char *manifest);

#ifdef __cplusplus
}
#endif

#endif
