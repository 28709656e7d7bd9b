/* SPDX-License-Identifier: BSD-3-Clause
 * Contact laws over arrays, in blocks that stay in the first cache.
 *
 * The closed forms go through a block in plain loops without calls and branches, which compilers turn into vector code.
 * They give the bits of the scalar law: the operations are the same, in the same order, and none is fused. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "contact/block.h"
#include "core/strided.h"
#include "core/variants.h"
#include "internal/contact.h"

/* Hertz' force less an adhesion, contiguous; force may be in. Returns 0 where some indentation is not finite: its
 * difference from itself is NaN, and so is its force. */
NT_VARIANTS static int closed_force(const nt_contact *contact, double adhesion, const double *in, double *force,
                                    long count)
{
    const double root = sqrt(contact->radius), twice = 2.0 * contact->effective_modulus;
    int64_t finite = -1;
    for (long i = 0; i < count; i++) {
        const double d = in[i], none = d - d, depth = d <= 0.0 ? 0.0 : d;
        const double hertz = 2.0 / 3.0 * (twice * (root * sqrt(depth))) * depth;
        force[i] = hertz - (d < 0.0 ? 0.0 : adhesion) + none;
        finite &= -(int64_t)(none == 0.0);
    }
    return finite != 0;
}

NT_VARIANTS static void closed_block(const nt_contact *contact, double adhesion, nt_law_block *block)
{
    const double root = sqrt(contact->radius), twice = 2.0 * contact->effective_modulus;
    for (int i = 0; i < NT_BLOCK; i++) {
        const double d = block->in[i], depth = d <= 0.0 ? 0.0 : d, pull = d < 0.0 ? 0.0 : adhesion;
        const double a = root * sqrt(depth), k = twice * a, F = 2.0 / 3.0 * k * depth;
        block->U[i] = 0.4 * F * depth - pull * depth;
        block->F[i] = F - pull;
        block->k[i] = k;
        block->a[i] = a;
    }
}

/* NaN for what is not finite; returns 0 where there is some. */
NT_VARIANTS static int not_finite_mark(nt_law_block *block)
{
    int64_t finite = -1;
    for (int i = 0; i < NT_BLOCK; i++) {
        const double none = block->in[i] - block->in[i];
        block->U[i] += none;
        block->F[i] += none;
        block->k[i] += none;
        block->a[i] += none;
        finite &= -(int64_t)(none == 0.0);
    }
    return finite != 0;
}

static nt_status one_by_one(const nt_contact_law *law, nt_branch branch, const nt_strided *arrays)
{
    nt_status first = NT_OK;
    for (long i = 0; i < arrays->count; i++) {
        nt_law_value value = {NAN, NAN, NAN, NAN};
        const nt_status status = nt_contact_law_eval(law, arrays->in[i * arrays->in_stride], branch, &value);
        if (first == NT_OK)
            first = status;
        nt_strided_store(arrays, i, value);
    }
    return first;
}

/* The arrays from element `from` on, `count` of them. */
static nt_strided part_of(const nt_strided *arrays, long from, long count)
{
    const long to = from * arrays->out_stride;
    return (nt_strided){
        .in = arrays->in + from * arrays->in_stride,
        .U = arrays->U ? arrays->U + to : NULL,
        .F = arrays->F ? arrays->F + to : NULL,
        .k = arrays->k ? arrays->k + to : NULL,
        .a = arrays->a ? arrays->a + to : NULL,
        .count = count,
        .in_stride = arrays->in_stride,
        .out_stride = arrays->out_stride,
    };
}

/* What is left of a block beyond the end of the array repeats its last element. */
static void block_load(const nt_strided *part, nt_law_block *block)
{
    for (long i = 0; i < NT_BLOCK; i++)
        block->in[i] = part->in[(i < part->count ? i : part->count - 1) * part->in_stride];
}

static void block_store(const nt_strided *part, const nt_law_block *block)
{
    for (long i = 0; i < part->count; i++)
        nt_strided_store(part, i, (nt_law_value){block->U[i], block->F[i], block->k[i], block->a[i]});
}

/* Fills the values at the indentations of a block; 0 where it has none of that kind. */
static int block_fill(const nt_contact_law *law, nt_branch branch, int force_alone, nt_law_block *block)
{
    const nt_contact *contact = &law->maugis.contact;
    if (law->model == NT_JKR && contact->work_of_adhesion > 0.0)
        return nt_jkr_block(contact, branch, block);
    if (law->model == NT_MAUGIS && contact->work_of_adhesion > 0.0)
        return nt_maugis_block(&law->maugis, branch, force_alone, block);
    closed_block(contact, law->model == NT_DMT ? nt_dmt_pull_off_force(contact) : 0.0, block);
    return 1;
}

static nt_status block_eval(const nt_contact_law *law, nt_branch branch, const nt_strided *part)
{
    nt_law_block block = {.U = {0.0}};
    block_load(part, &block);
    if (part->count < NT_BLOCK / 8 || !block_fill(law, branch, !part->U && !part->k && !part->a, &block))
        return one_by_one(law, branch, part);
    const nt_status status = not_finite_mark(&block) ? NT_OK : NT_E_NOT_FINITE;
    block_store(part, &block);
    return status;
}

nt_status nt_contact_law_eval_n(const nt_contact_law *law, nt_branch branch, const nt_strided *arrays)
{
    const nt_contact *contact = &law->maugis.contact;
    const int force_alone = arrays->F && !arrays->U && !arrays->k && !arrays->a;
    const int contiguous = arrays->in_stride == 1 && arrays->out_stride == 1;
    if (branch != NT_BRANCH_STABLE && branch != NT_BRANCH_APPROACH)
        return one_by_one(law, branch, arrays);
    if ((law->model == NT_HERTZ || law->model == NT_DMT) && force_alone && contiguous) {
        const double adhesion = law->model == NT_DMT ? nt_dmt_pull_off_force(contact) : 0.0;
        return closed_force(contact, adhesion, arrays->in, arrays->F, arrays->count) ? NT_OK : NT_E_NOT_FINITE;
    }
    nt_status first = NT_OK;
    for (long i = 0; i < arrays->count; i += NT_BLOCK) {
        const nt_strided part = part_of(arrays, i, arrays->count - i < NT_BLOCK ? arrays->count - i : NT_BLOCK);
        const nt_status status = block_eval(law, branch, &part);
        first = first == NT_OK ? status : first;
    }
    return first;
}
